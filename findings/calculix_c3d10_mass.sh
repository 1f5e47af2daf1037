#!/usr/bin/env bash
# CalculiX 2.20 (Debian 12, calculix-ccx 2.20-1): the mass matrix of a quadratic tetrahedron (C3D10)
# has rank 12, not 30.
#
# Seen: *FREQUENCY, SOLVER=MATRIXSTORAGE writes the matrices of one element of density 120 and volume
# 1/6. The stiffness has rank 24 (30 less six rigid motions), and the total mass is right, 20 in each
# direction. But the mass has rank 12: 18 independent motions of the ten nodes have no inertia at
# all. A corner's entry is 0.2 where exact integration gives 2/7. The mass is summed over the four
# integration points that are exact for the stiffness; the product of two quadratic shape functions
# is of fourth degree.
#
# So natural frequencies by CalculiX and by a program that integrates the mass exactly differ on the
# same mesh of C3D10, though their stiffness matrices are equal to rounding: compare on meshes that
# are fine for the mode, or take CalculiX's matrices.
. "$(dirname "$0")/support"
unpack calculix-ccx=2.20-1 libspooles2.2=2.2-14 libarpack2=3.8.0-3 libblas3=3.11.0-2 \
  liblapack3=3.11.0-2 libgfortran5=12.2.0-14+deb12u1

cat >element.inp <<'INPUT'
*NODE, NSET=ALL
1, 0, 0, 0
2, 1, 0, 0
3, 0, 1, 0
4, 0, 0, 1
5, .5, 0, 0
6, .5, .5, 0
7, 0, .5, 0
8, 0, 0, .5
9, .5, 0, .5
10, 0, .5, .5
*ELEMENT, TYPE=C3D10, ELSET=BODY
1, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10
*MATERIAL, NAME=SOFT
*ELASTIC
1, 0.3
*DENSITY
120
*SOLID SECTION, ELSET=BODY, MATERIAL=SOFT
*STEP
*FREQUENCY, SOLVER=MATRIXSTORAGE
*END STEP
INPUT
with_libraries "$root/usr/bin/ccx" element >log || { cat log; exit 2; }

# Each line of the two files is "row column value", of one triangle.
/usr/bin/python3 - >seen <<'PYTHON'
import numpy as np

def matrix(file):
    entries = np.loadtxt(file)
    full = np.zeros((30, 30))
    for row, column, value in entries:
        full[int(row) - 1, int(column) - 1] = full[int(column) - 1, int(row) - 1] = value
    return full

mass, stiffness = matrix("element.mas"), matrix("element.sti")
print(np.linalg.matrix_rank(stiffness, 1e-9), np.linalg.matrix_rank(mass, 1e-9),
      mass.sum() / 3, mass[0, 0])
PYTHON
read -r stiffness_rank mass_rank total corner <seen
echo "rank of stiffness $stiffness_rank, of mass $mass_rank; total mass $total; a corner's $corner"
still "the stiffness has rank 24" [ "$stiffness_rank" = 24 ]
still "the total mass is that of the body" is "abs($total - 20) < 1e-9"
still "a corner's entry is 0.2, not 2/7" is "abs($corner - 0.2) < 1e-9"
still "the mass has rank 12, not 30" [ "$mass_rank" = 12 ]
