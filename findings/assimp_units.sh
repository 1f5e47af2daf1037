#!/usr/bin/env bash
# Assimp 5.2.5 (Debian 12, assimp-utils and libassimp5 5.2.5~ds0-1+b1): a COLLADA file's unit of
# length is applied, a 3MF file's is not.
#
# Seen: one tetrahedron with edges of 10 units, written with the unit inch and with the unit metre in
# each of the two formats, all four valid. "assimp info" says that the COLLADA ones extend to 0.254
# and to 10, so it gives metres. The 3MF ones both extend to 10, whatever <model unit="…"> says, and
# so does one without the attribute, which by the format is in millimetres. There is no warning, and
# no property in what is exported tells them apart.
#
# So a body that is brought to a finite element model this way has natural frequencies that are wrong
# by the ratio of the units (25.4 for inches), and a scale that is right for one of the formats is
# wrong for the other. The unit has to be read from the file itself.
. "$(dirname "$0")/support"
unpack assimp-utils=5.2.5~ds0-1+b1 libassimp5=5.2.5~ds0-1+b1 libdraco7=1.5.5+dfsg-2

cat >write.py <<'PYTHON'
import zipfile

CORNERS = ((0, 0, 0), (10, 0, 0), (0, 10, 0), (0, 0, 10))
FACES = ((0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3))
XML = '<?xml version="1.0" encoding="UTF-8"?>'


def write_3mf(name, unit):
    corners = "".join(f'<vertex x="{x}" y="{y}" z="{z}"/>' for x, y, z in CORNERS)
    faces = "".join(f'<triangle v1="{a}" v2="{b}" v3="{c}"/>' for a, b, c in FACES)
    with zipfile.ZipFile(name, "w") as package:
        package.writestr("[Content_Types].xml", f"""{XML}
<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types">
<Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/>
<Default Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/></Types>""")
        package.writestr("_rels/.rels", f"""{XML}
<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships"><Relationship Target="/3D/3dmodel.model"
Id="model" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/></Relationships>""")
        package.writestr("3D/3dmodel.model", f"""{XML}
<model {f'unit="{unit}"' if unit else ""} xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02">
<resources><object id="1" type="model"><mesh><vertices>{corners}</vertices><triangles>{faces}</triangles></mesh></object></resources>
<build><item objectid="1"/></build></model>""")


def write_collada(name, metres):
    numbers = " ".join(str(value) for corner in CORNERS for value in corner)
    faces = " ".join(str(corner) for face in FACES for corner in face)
    with open(name, "w") as file:
        file.write(f"""{XML}
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><created>2020-01-01T00:00:00</created><modified>2020-01-01T00:00:00</modified>
<unit name="unit" meter="{metres}"/><up_axis>Y_UP</up_axis></asset>
<library_geometries><geometry id="body"><mesh>
<source id="corners"><float_array id="numbers" count="12">{numbers}</float_array><technique_common>
<accessor source="#numbers" count="4" stride="3"><param name="X" type="float"/><param name="Y" type="float"/>
<param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="vertices"><input semantic="POSITION" source="#corners"/></vertices>
<triangles count="4"><input semantic="VERTEX" source="#vertices" offset="0"/><p>{faces}</p></triangles>
</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="scene"><node><instance_geometry url="#body"/></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#scene"/></scene></COLLADA>""")


write_collada("inch.dae", 0.0254)
write_collada("metre.dae", 1)
write_3mf("inch.3mf", "inch")
write_3mf("metre.3mf", "meter")
write_3mf("none.3mf", "")
PYTHON
/usr/bin/python3 write.py

extent() {
  with_libraries "$root/usr/bin/assimp" info "$1" | sed -n 's/^Maximum point *(\([^ ]*\).*/\1/p'
}
for file in inch.dae metre.dae inch.3mf metre.3mf none.3mf; do
  echo "$file extends to $(extent $file)"
done

still "a COLLADA file is read in metres" \
  [ "$(extent inch.dae) $(extent metre.dae)" = "0.254000 10.000000" ]
still "a 3MF file is read as if it named no unit" \
  [ "$(extent inch.3mf) $(extent metre.3mf) $(extent none.3mf)" = "10.000000 10.000000 10.000000" ]
