"""Checks what `corcast pulse` writes. Shares no code with corcast.

    pulse.py waves T.swc V.csv Z.csv   V.csv has pressure and flow at evenly spaced moments. All nodes of
                                       the tree are solved together, by a sparse LU decomposition for each
                                       harmonic, with Bessel functions as friction.
    pulse.py deck D.json S.csv R.csv   solves the periodic state of a deck of svZeroDSolver, compares it
                                       with the summary S.csv, and writes the result R.csv as the solver
                                       does, with the names of the vessels.

The options of the run are in the environment: PERIOD (s), HARMONICS, OUTLET_TIME (s), VENOUS (mmHg), the wall law
WALL (K1,K2,K3). The drive is pressure, whose amplitudes are taken from the root impedance's own file: they are those
of the first node of V.csv, so that only the tree is checked."""

import csv
import json
import os
import re
import sys

import numpy as np
from scipy import special
from scipy.sparse import coo_matrix
from scipy.sparse.linalg import splu

PA = 133.322387415  # in 1 mmHg
RHO = 1.05e-3  # g/mm3


def fail(message):
    sys.exit(f"pulse.py: {message}")


def read_swc(path):
    """Ids, parents as indices, positions, radii and header of a tree."""
    meta, rows = {}, []
    for line in open(path):
        match = re.match(r"#\s*(\w+):\s*(.*)", line)
        if match:
            meta[match[1]] = match[2].strip()
        elif line.strip() and not line.startswith("#"):
            rows.append(line.split())
    ids = [int(row[0]) for row in rows]
    index = {id_: i for i, id_ in enumerate(ids)}
    parent = np.array([index.get(int(row[6]), -1) for row in rows])
    return ids, parent, np.array([row[2:5] for row in rows], float), np.array([float(row[5]) for row in rows]), meta


def read_table(path):
    rows = list(csv.reader(open(path)))
    return [re.sub(r" \[.*", "", title) for title in rows[0]], rows[1:]


def friction(alpha):
    """H of a Womersley number, by Bessel functions in a form without cancellation."""
    z = 1j**1.5 * alpha
    return z * special.jve(1, z) / (4 * special.jve(2, z))


def waves(tree, values, impedance):
    ids, parent, position, radius, meta = read_swc(tree)
    period, outlet_time = float(os.environ["PERIOD"]), float(os.environ["OUTLET_TIME"])
    venous = float(os.environ["VENOUS"]) * PA
    k1, k2, k3 = map(float, os.environ["WALL"].split(","))
    n, harmonics, viscosity = len(ids), int(os.environ["HARMONICS"]), float(meta["viscosity_cP"]) * 1e-3
    segment = np.flatnonzero(parent >= 0)
    root = np.flatnonzero(parent < 0)[0]
    start, r = parent[segment], radius[segment]
    length = np.linalg.norm(position[segment] - position[start], axis=1)
    terminal = np.setdiff1d(segment, start)

    # The steady solution: equal flow at all terminals, Poiseuille.
    flow = np.zeros(n)
    flow[terminal] = float(meta["q_perf_ml_min"]) * 1000 / 60 / len(terminal)
    for i in reversed(range(n)):
        if parent[i] >= 0:
            flow[parent[i]] += flow[i]
    pressure = np.zeros(n)
    pressure[root] = float(meta["p_perf_mmHg"]) * PA
    resistance = 8 * viscosity * length / (np.pi * r**4)
    for s, i in enumerate(segment):
        pressure[i] = pressure[parent[i]] - resistance[s] * flow[i]

    # The result of corcast: amplitudes from its moments.
    titles, rows = read_table(values)
    moments = [t for t in titles if t.startswith("pressure_")]
    if len(moments) <= 2 * harmonics:
        fail("too few moments")
    index = {id_: i for i, id_ in enumerate(ids)}
    at = {"pressure": np.zeros((n, len(moments))), "flow": np.zeros((n, len(moments)))}
    for row in rows:
        for title, value in zip(titles[1:], row[1:]):
            name, time = title.split("_")
            at[name][index[int(row[0])], round(float(time) / period * len(moments))] = float(value)
    p_of = 2 / len(moments) * np.fft.fft(at["pressure"], axis=1) * PA
    q_of = 2 / len(moments) * np.fft.fft(at["flow"], axis=1) * 1000 / 60
    worst_mean = max(
        np.max(np.abs(p_of[segment, 0].real / 2 - pressure[segment]) / pressure[root]),
        np.max(np.abs(q_of[segment, 0].real / 2 - flow[segment]) / flow[root]),
    )

    _, z_rows = read_table(impedance)
    area, stiffness = np.pi * r**2, k1 * np.exp(k2 * r) + k3
    total = (pressure[terminal] - venous) / flow[terminal]
    end = np.searchsorted(segment, terminal)
    rp = np.minimum(RHO * np.sqrt(stiffness[end] / 1.5 / RHO) / area[end], 0.99 * total)
    worst = worst_z = 0
    for k in range(1, harmonics + 1):
        omega = 2 * np.pi * k / period
        z = resistance * friction(r * np.sqrt(omega * RHO / viscosity)) + 1j * omega * RHO * length / area
        y = 1j * omega * 1.5 * area / stiffness * length
        gamma = np.sqrt(z * y)
        b, a = z * np.sinh(gamma) / gamma, np.cosh(gamma)
        load = np.zeros(n, complex)
        load[terminal] = 1 / (rp + (total - rp) / (1 + 1j * omega * (total - rp) * outlet_time / total))
        # Kirchhoff: the flows into all segments and outlets at a node add up to the flow from outside.
        at_nodes = np.concatenate([start, segment, start, segment, np.arange(n)])
        columns = np.concatenate([start, segment, segment, start, np.arange(n)])
        entries = np.concatenate([a / b, a / b, -1 / b, -1 / b, load])
        matrix = coo_matrix((entries, (at_nodes, columns)), (n, n)).tocsc()
        inner = np.setdiff1d(np.arange(n), root)
        p = np.zeros(n, complex)
        p[root] = 1
        p[inner] = splu(matrix[inner][:, inner]).solve(-matrix[inner][:, [root]].toarray()[:, 0])
        q_root = (matrix[[root]] @ p)[0]
        size, phase = float(z_rows[k][3]) * PA * 1e-3, np.radians(float(z_rows[k][4]))
        worst_z = max(worst_z, abs(size * np.exp(1j * phase) * q_root - 1))
        q = np.zeros(n, complex)
        q[segment] = (p[start] - a * p[segment]) / b
        # The amplitude at the root is not in the file: compare relative to the first segment.
        scale = p_of[segment[0], k] / p[segment[0]]
        worst = max(worst, np.max(np.abs(p_of[segment, k] - scale * p[segment])) / abs(scale))
        worst = max(worst, np.max(np.abs(q_of[segment, k] - scale * q[segment])) / abs(scale * q_root))
    print(f"mean {worst_mean:.2g}, waves {worst:.2g}, root impedance {worst_z:.2g}")
    if worst_mean > 1e-12 or worst > 1e-9 or worst_z > 1e-10:
        fail("the waves differ from those of the sparse solution")


# ---- decks ---------------------------------------------------------------------------------------

VALUES = {
    "FLOW": {"Q", "t"},
    "PRESSURE": {"P", "t"},
    "RESISTANCE": {"R", "Pd"},
    "RCR": {"Rp", "C", "Rd", "Pd"},
    "CORONARY": {"Ra1", "Ra2", "Rv1", "Ca", "Cc", "P_v", "Pim", "t"},
}


def fourier(times, values, n):
    """Mean and amplitudes of a polygon."""
    t, x = np.array(times), np.array(values)
    if t[0] != 0 or np.any(np.diff(t) <= 0) or x[0] != x[-1]:
        fail("a waveform must begin at 0, rise, and end as it begins")
    k = np.arange(1, n + 1)[:, None]
    omega = 2 * np.pi * k / t[-1]
    turn = np.exp(-1j * omega * t[None, :])
    slope = np.diff(x) / np.diff(t)
    c = 2 / t[-1] * np.sum(slope * np.diff(turn, axis=1), axis=1) / omega[:, 0] ** 2
    return np.concatenate([[np.trapz(x, t) / t[-1]], c])


def read_deck(path):
    deck = json.load(open(path))
    bcs = {}
    for bc in deck["boundary_conditions"]:
        if set(bc["bc_values"]) != VALUES[bc["bc_type"]] or bc["bc_name"] in bcs:
            fail(f"the keys of {bc['bc_name']} are wrong, or its name occurs twice")
        bcs[bc["bc_name"]] = bc
    vessels = {v["vessel_id"]: v for v in deck["vessels"]}
    if len(vessels) != len(deck["vessels"]) or len({v["vessel_name"] for v in vessels.values()}) != len(vessels):
        fail("two vessels have one id or name")
    down, up = {}, {}
    for junction in deck["junctions"]:
        if junction["junction_type"] != "NORMAL_JUNCTION" or len(junction["inlet_vessels"]) != 1:
            fail(f"junction {junction['junction_name']} is not normal")
        (inlet,) = junction["inlet_vessels"]
        if inlet in down:
            fail(f"vessel {inlet} ends in two junctions")
        down[inlet] = junction["outlet_vessels"]
        for outlet in junction["outlet_vessels"]:
            if outlet in up:
                fail(f"vessel {outlet} begins in two junctions")
            up[outlet] = inlet
    used = set()
    for id_, vessel in vessels.items():
        ends = vessel.get("boundary_conditions", {})
        if ("inlet" in ends) == (id_ in up) or ("outlet" in ends) == (id_ in down):
            fail(f"vessel {id_} must have a junction or a boundary condition at each end")
        used |= set(ends.values())
    if used != set(bcs):
        fail("a boundary condition is not used")
    return deck, bcs, vessels, down


def outlet(bc, omega, k, harmonics):
    """Admittance and source of an outlet: q = y p - j."""
    v = bc["bc_values"]
    if bc["bc_type"] == "RESISTANCE":
        return 1 / v["R"], v["Pd"] / v["R"] * (k == 0)
    if bc["bc_type"] == "RCR":
        y = 1 / (v["Rp"] + v["Rd"] / (1 + 1j * omega * v["Rd"] * v["C"]))
        return y, v["Pd"] * y * (k == 0)
    pim = fourier(v["t"], v["Pim"], harmonics)[k]
    y2 = 1j * omega * v["Cc"] + 1 / v["Rv1"]
    j2 = 1j * omega * v["Cc"] * pim + v["P_v"] / v["Rv1"] * (k == 0)
    y1 = 1 / (v["Ra2"] + 1 / y2) + 1j * omega * v["Ca"]
    j1 = j2 / (1 + v["Ra2"] * y2)
    return 1 / (v["Ra1"] + 1 / y1), j1 / (1 + v["Ra1"] * y1)


def solve_deck(path, harmonics):
    """Amplitudes of p_in, q_in, p_out, q_out of each vessel."""
    deck, bcs, vessels, down = read_deck(path)
    period = deck["simulation_parameters"]["cardiac_period"]
    ups = {outlet_: inlet for inlet, outlets in down.items() for outlet_ in outlets}
    roots = [id_ for id_ in vessels if id_ not in ups]
    order, todo = [], list(roots)
    while todo:
        order.append(todo.pop())
        todo += down.get(order[-1], [])
    if len(order) != len(vessels):
        fail("not all vessels can be reached from an inlet")
    result = {id_: np.zeros((4, harmonics + 1), complex) for id_ in vessels}
    for k in range(harmonics + 1):
        omega = 2 * np.pi * k / period
        y_out, j_out, y_in, j_in, port = {}, {}, {}, {}, {}
        for id_ in reversed(order):
            v = vessels[id_]["zero_d_element_values"]
            if id_ in down:
                y_out[id_] = sum(y_in[i] for i in down[id_])
                j_out[id_] = sum(j_in[i] for i in down[id_])
            else:
                bc = bcs[vessels[id_]["boundary_conditions"]["outlet"]]
                y_out[id_], j_out[id_] = outlet(bc, omega, k, harmonics)
            # R first, then C to ground, then L; z y - 1 form from the end.
            zl, yc, rr = 1j * omega * v.get("L", 0), 1j * omega * v.get("C", 0), v["R_poiseuille"]
            y, j = y_out[id_] / (1 + zl * y_out[id_]), j_out[id_] / (1 + zl * y_out[id_])
            y, port[id_] = y + yc, (zl, yc, rr, y + yc, j)
            y_in[id_], j_in[id_] = y / (1 + rr * y), j / (1 + rr * y)
        for id_ in order:
            bc = bcs.get(vessels[id_].get("boundary_conditions", {}).get("inlet"))
            if bc and bc["bc_type"] == "PRESSURE":
                p = fourier(bc["bc_values"]["t"], bc["bc_values"]["P"], harmonics)[k]
            elif bc:
                q = fourier(bc["bc_values"]["t"], bc["bc_values"]["Q"], harmonics)[k]
                p = (q + j_in[id_]) / y_in[id_]
            else:
                p = result[ups[id_]][2, k]
            zl, yc, rr, y, j = port[id_]
            q = y_in[id_] * p - j_in[id_]
            middle = p - rr * q
            q_end = q - yc * middle
            result[id_][:, k] = p, q, middle - zl * q_end, q_end
    return {vessels[id_]["vessel_name"]: amplitudes for id_, amplitudes in result.items()}, period


def deck(path, summary, out):
    harmonics = int(os.environ["HARMONICS"])
    result, period = solve_deck(path, harmonics)
    times = np.arange(25) / 24 * period
    titles, rows = read_table(summary)
    expected = {f"branch{row[0]}_seg0": dict(zip(titles[1:], map(float, row[1:]))) for row in rows}
    if set(result) != set(expected):
        fail("the vessels are not the segments")
    worst_mean = worst_pulse = 0
    pulse = max(e["pressure_max"] - e["pressure_min"] for e in expected.values())
    with open(out, "w") as file:
        file.write("name,time,flow_in,flow_out,pressure_in,pressure_out\n")
        for name, c in result.items():
            turn = np.exp(2j * np.pi * np.arange(1, harmonics + 1)[:, None] * times[None, :] / period)
            p_in, q_in, p_out, q_out = c[:, :1].real + (c[:, 1:] @ turn).real
            for row in zip(times, q_in, q_out, p_in, p_out):
                file.write(name + "," + ",".join(f"{x:.12g}" for x in row) + "\n")
            e = expected[name]
            worst_mean = max(worst_mean, abs(c[2, 0].real / PA / 10 / e["pressure_mean"] - 1))
            worst_mean = max(worst_mean, abs(c[3, 0].real * 60 / e["flow_mean"] - 1))
            for value, key in (min(p_out), "pressure_min"), (max(p_out), "pressure_max"):
                worst_pulse = max(worst_pulse, abs(value / PA / 10 - e[key]) / pulse)
    print(f"{len(result)} vessels: mean {worst_mean:.2g}, pulse {worst_pulse:.2g}")
    if worst_mean > 1e-6 or worst_pulse > 0.03:
        fail("the deck does not have the waves of the tree")


if __name__ == "__main__":
    if len(sys.argv) != 5 or sys.argv[1] not in ("waves", "deck"):
        fail("give waves T.swc V.csv Z.csv, or deck D.json S.csv R.csv")
    {"waves": waves, "deck": deck}[sys.argv[1]](*sys.argv[2:])
