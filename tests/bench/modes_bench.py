#!/usr/bin/python3
"""modes_bench.py TAPSTUDY: a whole `modes` run against CalculiX and SciPy on the same mesh of
quadratic tetrahedra, for the same eight modes, medians of three runs (SciPy's long ones are made once); then a larger plate, and
how the time grows."""
import json
import math
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time

import numpy as np
from scipy import sparse
from scipy.sparse import linalg

E, NU, RHO = 2.5e9, 0.25, 610.0
WIDTH, THICKNESS = 0.6, 0.05
MODES = 8
EDGES = [(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)]


def protocol(folder, tet_volume, band):
    file = folder / "plate.yaml"
    file.write_text(f"""format: tapstudy/1
title: bench
finger: {{mass_kg: 0.058, stiffness_n_per_m: 300, damping_n_s_per_m: 3}}
rendering: {{rate_hz: 10000, penalty_stiffness_n_per_m: 3000, band_limit_hz: {band}, integrator: exact}}
placement: {{origin_m: [0, 0, 0], lateral_scale: 0.1}}
materials:
  mdf: {{youngs_modulus_pa: {E}, density_kg_per_m3: {RHO}, poissons_ratio: {NU}, damping: {{alpha_per_s: 120, beta_s: 7.05e-5}}}}
plates:
  plate:
    size_m: [{WIDTH}, {WIDTH}, {THICKNESS}]
    mesh: {{order: 2, max_tet_volume_m3: {tet_volume}}}
    fixations: [{{region: side, side: left, axes: xyz}}]
tapping_points_m: {{middle: [0, 0]}}
stimuli:
  plate: {{label: plate, plate: plate, material: mdf, technique: fem}}
""")
    return file


def run(*command, threads=None):
    environment = dict(os.environ)
    if threads:
        environment.update(OMP_NUM_THREADS=str(threads), CCX_NPROC_EQUATION_SOLVER=str(threads),
                           OPENBLAS_NUM_THREADS=str(threads))
    start = time.perf_counter()
    done = subprocess.run(list(map(str, command)), capture_output=True, text=True, check=True,
                          env=environment)
    return time.perf_counter() - start, done.stdout


def modes(tapstudy, file, *more):
    seconds, out = run(tapstudy, "modes", file, "--stimulus", "plate", "--json", *more)
    return seconds, json.loads(out)


def band_of_eight(tapstudy):
    """Midway between the eighth and the ninth mode: no mesh below moves them that far."""
    with tempfile.TemporaryDirectory() as name:
        hz = modes(tapstudy, protocol(pathlib.Path(name), 1.5e-5, 1000))[1]["frequencies_hz"]
    return 0.5 * (hz[MODES - 1] + hz[MODES])


def read_mesh(prefix):
    nodes = np.loadtxt(f"{prefix}.node", skiprows=1)[:, 1:4]
    tets = np.loadtxt(f"{prefix}.ele", skiprows=1, dtype=int)[:, 1:11]
    original = tets.copy()
    # whichever way its corners turn; middles are told by where they lie
    a, b, c, d = (nodes[tets[:, i]] for i in range(4))
    turned = np.einsum("ij,ij->i", np.cross(b - a, c - a), d - a) < 0
    tets[turned, :2] = tets[turned, 1::-1]
    middles = nodes[tets[:, 4:]]
    for place, (i, j) in enumerate(EDGES):
        halfway = 0.5 * (nodes[tets[:, i]] + nodes[tets[:, j]])
        nearest = np.linalg.norm(middles - halfway[:, None], axis=2).argmin(axis=1)
        tets[:, 4 + place] = original[np.arange(len(tets)), 4 + nearest]
    return nodes, tets, np.abs(nodes[:, 0] + WIDTH / 2) < 1e-9


def calculix_input(folder, nodes, tets, held):
    with open(folder / "plate.inp", "w") as out:
        out.write("*NODE, NSET=ALL\n")
        out.writelines(f"{i + 1},{x:.12g},{y:.12g},{z:.12g}\n" for i, (x, y, z) in enumerate(nodes))
        out.write("*ELEMENT, TYPE=C3D10, ELSET=BODY\n")
        out.writelines(f"{i + 1}," + ",".join(str(n + 1) for n in tet) + "\n"
                       for i, tet in enumerate(tets))
        out.write(f"*MATERIAL, NAME=M\n*ELASTIC\n{E},{NU}\n*DENSITY\n{RHO}\n"
                  "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n*BOUNDARY\n")
        out.writelines(f"{i + 1},1,3\n" for i in np.flatnonzero(held))
        out.write(f"*STEP\n*FREQUENCY\n{MODES}\n*END STEP\n")


def calculix(folder, threads):
    seconds, _ = run("sh", "-c", f"cd {folder} && ccx plate", threads=threads)
    rows = [line.split() for line in open(folder / "plate.dat")]
    return seconds, [float(row[3]) for row in rows if len(row) == 5 and row[0].isdigit()][:MODES]


def assemble(nodes, tets, held):
    """Stiffness by four points, mass by the exact integrals over the reference tetrahedron."""
    count = len(tets)
    corners = nodes[tets[:, :4]]
    jacobian = np.concatenate([np.ones((count, 4, 1)), corners], axis=2)
    volume = np.linalg.det(jacobian) / 6
    linear = np.linalg.inv(jacobian)[:, 1:, :].transpose(0, 2, 1)
    lame, shear = E * NU / ((1 + NU) * (1 - 2 * NU)), E / (2 * (1 + NU))
    near, far = (5 + 3 * math.sqrt(5)) / 20, (5 - math.sqrt(5)) / 20
    stiffness = np.zeros((count, 10, 3, 10, 3))
    for point in range(4):
        place = [near if i == point else far for i in range(4)]
        g = np.stack([(4 * place[i] - 1) * linear[:, i] for i in range(4)] +
                     [4 * (place[j] * linear[:, i] + place[i] * linear[:, j]) for i, j in EDGES], 1)
        w = volume / 4
        stiffness += lame * np.einsum("t,tai,tbj->taibj", w, g, g, optimize=True)
        stiffness += shear * np.einsum("t,taj,tbi->taibj", w, g, g, optimize=True)
        dots = shear * np.einsum("t,tak,tbk->tab", w, g, g, optimize=True)
        for axis in range(3):
            stiffness[:, :, axis, :, axis] += dots
    # shape functions as polynomials in the four barycentric coordinates, squared and integrated
    shapes = [{(i, i): 2.0, (i,): -1.0} for i in range(4)] + [{(i, j): 4.0} for i, j in EDGES]

    def integral(*indices):
        powers = [indices.count(i) for i in range(4)]
        return 6 * math.prod(map(math.factorial, powers)) / math.factorial(len(indices) + 3)

    share = np.array([[sum(x * y * integral(*p, *q) for p, x in a.items() for q, y in b.items())
                       for b in shapes] for a in shapes])
    mass = np.einsum("t,ab->tab", RHO * volume, share)
    free = np.repeat(~held, 3)
    place = np.cumsum(free) - 1
    dofs = 3 * tets[:, :, None] + np.arange(3)
    k = sparse_of(stiffness.reshape(count, 30, 30), dofs.reshape(count, 30), free, place)
    m = sum(sparse_of(mass, dofs[:, :, axis], free, place) for axis in range(3))
    return k, m


def sparse_of(blocks, dofs, free, place):
    rows = np.broadcast_to(dofs[:, :, None], blocks.shape).ravel()
    columns = np.broadcast_to(dofs[:, None, :], blocks.shape).ravel()
    kept = free[rows] & free[columns]
    size = place[-1] + 1
    return sparse.csc_matrix((blocks.ravel()[kept], (place[rows[kept]], place[columns[kept]])),
                             shape=(size, size))


def scipy(nodes, tets, held):
    start = time.perf_counter()
    k, m = assemble(nodes, tets, held)
    values = linalg.eigsh(k, MODES, m, sigma=0, which="LM", return_eigenvectors=False)
    return time.perf_counter() - start, np.sqrt(np.sort(values)) / (2 * math.pi)


def apart(a, b):
    return max(abs(x / y - 1) for x, y in zip(a, b))


def compare(tapstudy, band, tet_volume, scipy_rounds):
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        file = protocol(folder, tet_volume, band)
        ours = modes(tapstudy, file, "--mesh-out", folder / "plate")[1]
        mesh = read_mesh(folder / "plate")
        calculix_input(folder, *mesh)
        times = {"tapstudy": [], "CalculiX, 1 thread": [], "CalculiX, 2 threads": [], "SciPy": []}
        for round_ in range(3):
            times["tapstudy"].append(modes(tapstudy, file)[0])
            for threads in (1, 2):
                seconds, ccx_hz = calculix(folder, threads)
                times[f"CalculiX, {threads} thread{'s' * (threads > 1)}"].append(seconds)
            if round_ < scipy_rounds:
                seconds, scipy_hz = scipy(*mesh)
                times["SciPy"].append(seconds)
        median = {who: statistics.median(seconds) for who, seconds in times.items()}
        own = median.pop("tapstudy")
        print(f"{ours['dof']} dof, {len(ours['frequencies_hz'])} modes: tapstudy {own:.2f} s")
        for who, seconds in median.items():
            print(f"  {who:<20} {seconds:6.2f} s, {seconds / own:5.1f} times as long")
        hz = ours["frequencies_hz"]
        print(f"  frequencies apart: CalculiX {apart(hz, ccx_hz):.0e}, SciPy {apart(hz, scipy_hz):.0e}",
              flush=True)
        return ours["dof"], own


def alone(tapstudy, band, tet_volume):
    with tempfile.TemporaryDirectory() as name:
        seconds, json_ = modes(tapstudy, protocol(pathlib.Path(name), tet_volume, band))
        stages = ", ".join(f"{stage} {s:.2f}" for stage, s in json_["seconds"].items())
        print(f"{json_['dof']} dof: tapstudy {seconds:.1f} s ({stages}), "
              f"{json_['peak_memory_bytes'] / 1e9:.1f} GB")
        return json_["dof"], seconds


def main():
    tapstudy = pathlib.Path(sys.argv[1]).resolve()
    band = band_of_eight(tapstudy)
    points = [compare(tapstudy, band, 2.0e-5, 3), compare(tapstudy, band, 4.4e-6, 1),
              alone(tapstudy, band, 7.9e-7)]
    exponent = np.polyfit(*np.log(np.array(points)).T, 1)[0]
    print(f"time grows as the {exponent:.2f}th power of the degrees of freedom")


main()
