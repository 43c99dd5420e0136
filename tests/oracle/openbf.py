"""Compares `corcast pulse` with the nonlinear solver openBF in the 77 tubes of ADAN56.

    openbf.py CORCAST DATA    DATA has adan56.csv (tubes and outlets) and adan56-openbf.csv (pressure and flow at five
                              points of six tubes in the second cycle after a start from rest, and the inflow).
                              CORCAST is the program. Files are written into the current folder.

openBF starts at 10 kPa with empty outlets, and its second cycle is not periodic. Solutions of a linear model can be
added, so the second cycle is the periodic solution less what the start changes. A run over a cycle of 20 s gives the
change: its inflow is the beats before the start, which did not happen, less the blood that the tubes hold at the start.
Each beat before the start is one smooth bump, because only its volume and its time still matter a second later.

Each tube has one radius, its inlet radius, as in openBF. The model is linear about the mean pressure of the second
cycle, which is found by iteration. corcast's density is 1.05 g/cm3 and openBF's is 1.06, so all masses are scaled, and
the results are scaled back. These differences remain: friction follows Womersley here and Poiseuille in openBF; the
stiffness is a fit of three numbers to openBF's law (within 5.3 %); this model has no convection, and its areas do not
change over the cycle. With Poiseuille friction in corcast the errors were 1.1 % and 4.0 % on average."""

import csv
import subprocess
import sys

import numpy as np

MASS = 1.05 / 1.06
PER_MMHG = 133.322387415
ML_PER_MIN = 0.06  # in 1 mm3/s
MU, EXTERNAL, YOUNG = 4e-3, 1e4, 2.25e5  # Pa s, Pa, Pa
POINTS = 0.002, 0.25, 0.5, 0.75, 1.0  # ends of the segments of a tube, fractions of its length
LONG, BEATS, BUMP = 20, 16, 0.25  # cycle (s) of the change, beats before the start, half width (s) of a bump
# Mean and largest error that pass, %. Measured: 1.69 and 3.87, 6.77 and 12.51. A wall that is 10 % stiffer or softer
# has a mean error of the pressure above 4 %.
BOUNDS = {"pressure": (1.8, 4.2), "flow": (7.0, 13.0)}


def read(path):
    """Rows of a table: the name, and the numbers by the titles of their columns."""
    with open(path) as file:
        rows = list(csv.DictReader(line for line in file if line[0] != "#"))
    return [{"name": row.pop("name"), **{k: float(v) for k, v in row.items() if v}} for row in rows]


def resistances(tubes, radius):
    """Poiseuille resistance of each tube together with all tubes and outlets behind it, in Pa s/mm3."""
    total = [8 * MU * t["length"] / np.pi / r**4 for t, r in zip(tubes, radius)]
    for i in reversed(range(len(tubes))):
        behind = [1 / total[j] for j, t in enumerate(tubes) if t["start"] == tubes[i]["end"]]
        total[i] += 1 / sum(behind) if behind else tubes[i]["r1"] + tubes[i]["r2"]
    return total


def write_tree(tubes, radius):
    """Writes the tree, its outlets and their mean flows. The id of point k of tube i is 2 + 5 i + k. Returns the
    resistance of the whole tree, in Pa s/mm3."""
    total = resistances(tubes, radius)
    ends, flow = {1: (1, np.zeros(3), 1.0)}, []
    with open("tree.swc", "w") as tree, open("outlets.csv", "w") as outlets, open("split.csv", "w") as split:
        tree.write(f"1 3 0 0 0 {radius[0]:.12g} -1\n")
        outlets.write("id,rp,c,rd\n")
        split.write("id,flow\n")
        for i, (t, r) in enumerate(zip(tubes, radius)):
            parent, position, inflow = ends[t["start"]]
            conductances = [1 / total[j] for j, u in enumerate(tubes) if u["start"] == t["start"]]
            flow.append(inflow / total[i] / sum(conductances))
            along = t["length"] * np.array([np.cos(0.7 * i), np.sin(0.7 * i), 0.3 * i - 11]) / np.hypot(1, 0.3 * i - 11)
            for k, fraction in enumerate(POINTS):
                x, y, z = position + fraction * along
                tree.write(f"{2 + 5 * i + k} 3 {x:.12g} {y:.12g} {z:.12g} {r:.12g} {parent}\n")
                parent = 2 + 5 * i + k
            ends[t["end"]] = parent, position + along, flow[-1]
            if "c" in t:
                factor = MASS * 1000 / PER_MMHG
                outlets.write(f"{parent},{t['r1'] * factor:.12g},{t['c'] / factor:.12g},{t['r2'] * factor:.12g}\n")
                split.write(f"{parent},{flow[-1]:.12g}\n")
    return total[0]


def fit_wall(tubes, radius, stiffness):
    """K1, K2 and K3 of the wall law that are nearest to the stiffnesses, weighted by compliance."""
    weight = np.sqrt([t["length"] * r * r / s for t, r, s in zip(tubes, radius, stiffness)]) / stiffness

    def fit(k2):
        columns = np.array([np.exp(k2 * radius), np.ones(len(radius))]).T
        k, *_ = np.linalg.lstsq(columns * weight[:, None], stiffness * weight, rcond=None)
        return np.sum(((columns @ k - stiffness) * weight) ** 2), k[0], k2, k[1]

    return min(fit(-k2) for k2 in np.arange(0.05, 1, 0.01))[1:]


def run(times, inflow, root, wall, frames):
    """Times, pressures and flows by segment id of one cycle with this inflow (mm3/s)."""
    with open("drive.csv", "w") as file:
        file.write("time,flow\n")
        file.writelines(f"{t:.12g},{q:.12g}\n" for t, q in zip(times, inflow))
    mean = np.trapz(inflow, times) / times[-1]
    subprocess.run(
        [sys.argv[1], "pulse", "tree.swc", "--input-unit", "mm", "--drive", "drive.csv", "--drive-is", "flow",
         "--harmonics", "64", "--q-perf", repr(mean * ML_PER_MIN), "--p-perf", repr(mean * root * MASS / PER_MMHG),
         "--viscosity", repr(1e3 * MU * MASS), "--flow-split", "split.csv", "--outlets", "outlets.csv",
         "--venous-pressure", "0", "--wall", ",".join(repr(float(k)) for k in wall), "--fields", "pressure,flow",
         "--frames", str(frames), "-o", "values.csv", "--quiet"], check=True)
    with open("values.csv") as file:
        titles, *rows = list(csv.reader(file))
    values = np.array(rows, float)
    at = [i for i, title in enumerate(titles) if title.startswith("pressure")]
    to = [i for i, title in enumerate(titles) if title.startswith("flow")]
    order = np.argsort(values[:, 0])
    return (np.arange(frames) * times[-1] / frames, values[order][:, at] * PER_MMHG / MASS,
            values[order][:, to] / ML_PER_MIN)


def at_times(result, period, times):
    """Pressures and flows at the times, linear between the moments of a cycle."""
    moments, *fields = result
    return [np.array([np.interp(times, moments, x, period=period) for x in field]) for field in fields]


def second_cycle(tubes, radius, wall, content, knots, beat, times):
    """Pressures and flows of all segments at the times, seconds after the start from rest."""
    root = write_tree(tubes, radius)
    fine = np.union1d(np.linspace(0, 1, 401), knots)
    volume = np.trapz(beat, knots)
    centre = np.trapz(np.interp(fine, knots, beat) * fine, fine) / volume
    periodic = at_times(run(fine, np.interp(fine, knots, beat), root, wall, 500), 1, times)
    long = np.linspace(0, LONG, 1001)

    def bump(time):
        from_centre = np.abs((long - time + LONG / 2) % LONG - LONG / 2)
        return np.where(from_centre < BUMP, np.cos(np.pi * from_centre / BUMP / 2) ** 2 / BUMP, 0)

    missing = sum(volume * bump(centre - k) for k in range(1, BEATS + 1)) - content * bump(0)
    change = at_times(run(long, missing, root, wall, 500), LONG, times)
    return [p - c for p, c in zip(periodic, change)]


def main(data):
    tubes = read(f"{data}/adan56.csv")
    stored = read(f"{data}/adan56-openbf.csv")
    knots, beat = np.array([(row["time"], 1000 * row["q0"]) for row in stored if row["name"] == "inflow"]).T
    r0 = np.array([t["radius"] for t in tubes])
    length = np.array([t["length"] for t in tubes])
    at_rest = YOUNG * (0.2802 * np.exp(-0.5053 * r0) + 0.1324 * np.exp(-0.01114 * r0))
    beta = 4 / 3 * at_rest
    mean = np.full(len(tubes), 1.3e4)
    for _ in range(2):
        strain = (mean - EXTERNAL) / beta
        radius, stiffness, area = r0 * (1 + strain), at_rest * (1 + strain), np.pi * r0**2
        # Volume that a linear wall holds above pressure 0 when openBF's tube has its area at rest.
        content = np.sum(length * area * (2 * (1 + strain) / beta * mean - (1 + strain) ** 2 + 1))
        wall = fit_wall(tubes, radius, stiffness)
        pressure, _ = second_cycle(tubes, radius, wall, content, knots, beat, 1 + np.arange(100) / 100)
        mean = pressure[2::5].mean(axis=1)
    times = np.array([row["time"] for row in stored if row["name"] == tubes[0]["name"]])
    pressure, flow = second_cycle(tubes, radius, wall, content, knots, beat, times)
    errors = {"pressure": [], "flow": []}
    for i, t in enumerate(tubes):
        rows = [row for row in stored if row["name"] == t["name"]]
        if not rows:
            continue
        for name, ours in ("pressure", pressure), ("flow", flow / 1000):
            theirs = np.array([[row[f"{name[0].replace('f', 'q')}{k}"] for row in rows] for k in range(len(POINTS))])
            rms = np.sqrt(np.mean((ours[len(POINTS) * i:len(POINTS) * (i + 1)] - theirs) ** 2, axis=1))
            errors[name].append(100 * rms / np.abs(theirs).max(axis=1))
            print(f"{t['name']:26}{name:10}" + " ".join(f"{e:5.1f}" for e in errors[name][-1]), "%")
    for name, (most_mean, most) in BOUNDS.items():
        mean, worst = np.mean(errors[name]), np.max(errors[name])
        print(f"{name}: mean {mean:.2f} %, worst {worst:.2f} %")
        if not (mean <= most_mean and worst <= most):
            sys.exit(f"openbf.py: {name} differs by more than {most_mean} % on average or {most} % at a point")


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit("openbf.py: give the program corcast and the folder of adan56.csv")
    main(sys.argv[2])
