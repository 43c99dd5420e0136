"""Checks what `corcast flow` computes for a network of Secomb (network.dat). Shares no code with corcast: all
nodes are solved together, by dense matrices.

    flow.py make N.dat                  writes a network of 4 x 5 nodes with loops, a parallel vessel and four ends
    flow.py stored N.dat F.csv          compares the flow with the one that N.dat states
    flow.py separation N.dat F.csv H PLASMA CELLS
                                        iterates viscosity, flow and hematocrit: start, cP, fl
    flow.py estimate N.dat F.csv CP PRESSURE STRESS
                                        minimizes with Lagrange multipliers: viscosity, mmHg, Pa

F.csv is the network with its fields, one row per node, whose segment comes from its parent."""

import csv
import sys

import numpy as np

MMHG = 133.322387415  # Pa
PRIES = (0.964, 6.98, -13.29)


def make(path):
    rng = np.random.default_rng(7)
    at = {(i, j): 5 * i + j + 1 for i in range(4) for j in range(5)}
    points = {n: (100 * i + 20 * rng.random(), 90 * j + 20 * rng.random(), 15 * rng.random()) for (i, j), n in at.items()}
    pairs = [(at[k], at[k[0] + a, k[1] + b]) for k in at for a, b in ((1, 0), (0, 1)) if (k[0] + a, k[1] + b) in at]
    pairs = [p[::-1] if rng.random() < 0.5 else p for p in pairs] + [(7, 8)]
    ends = {21: (1, 0, 45.5), 22: (20, 2, -2.75), 23: (5, 0, 12.25), 24: (13, 2, 3.125)}
    for n, (to, _, _) in ends.items():
        points[n] = tuple(np.array(points[to]) + (-40, 35, 60))
        pairs.append((n, to))
    with open(path, "w") as out:
        out.write("made\n1 1 1\n1 1 1\n1\n1\n6\n%d segments\nname type from to diam flow hem\n" % len(pairs))
        for k, (a, b) in enumerate(pairs):
            out.write("%d 5 %d %d %.2f 0 0.4\n" % (k + 1, a, b, 6 + 9 * rng.random() + 4 * (max(a, b) > 20)))
        out.write("%d nodes\nname x y z\n" % len(points))
        for n, p in points.items():
            out.write("%d %.3f %.3f %.3f\n" % (n, *p))
        out.write("%d boundary nodes\nnode type value hem\n" % len(ends))
        for n, (_, kind, value) in ends.items():
            out.write("%d %d %g %g\n" % (n, kind, value, 0.45 if n == 24 else 0.4))


class Net:
    def __init__(self, path):
        lines = open(path).read().split("\n")[6:]
        tables = []
        for _ in range(3):
            n = int(lines[0].split()[0])
            tables.append([[float(x) for x in row.replace("*", "").split()] for row in lines[2 : 2 + n]])
            lines = lines[2 + n :]
        seg, nodes, bound = tables
        self.index = {int(r[0]): k for k, r in enumerate(nodes)}
        self.xyz = np.array([r[1:4] for r in nodes]) / 1000  # mm
        self.ends = np.array([[self.index[int(r[2])], self.index[int(r[3])]] for r in seg])
        self.um = np.array([r[4] for r in seg])
        self.stored = np.array([r[5] for r in seg])
        self.length = np.linalg.norm(self.xyz[self.ends[:, 0]] - self.xyz[self.ends[:, 1]], axis=1)
        n = self.n = len(nodes)
        self.p, self.q, self.h = np.full(n, np.nan), np.zeros(n), np.full(n, np.nan)
        self.stated = np.zeros(n, bool)
        self.part = np.arange(n)  # the first node of the component
        for _ in range(n):
            for a, b in self.ends:
                self.part[[a, b]] = self.part[[a, b]].min()
        for r in bound:
            k = self.index[int(r[0])]
            self.stated[k] = True
            self.h[k] = r[3]
            if r[1] == 0:
                self.p[k] = r[2] * MMHG
            else:
                self.q[k] = r[2] / 60e3  # nl/min to mm3/s

    def laplacian(self, g):
        k = np.zeros((self.n, self.n))
        for (a, b), x in zip(self.ends, g):
            k[a, a] += x
            k[b, b] += x
            k[a, b] -= x
            k[b, a] -= x
        return k

    def solve(self, viscosity):
        """Flow along the segments, and pressures. A component without a known pressure has 0 at one node, where the
        inflow is largest, and takes what is left of the sum of the inflows."""
        g = np.pi * (self.um / 2e3) ** 4 / (8 * viscosity * self.length)
        p = self.p.copy()
        for part in set(self.part):
            if np.isnan(p[self.part == part]).all():
                p[np.argmax(np.abs(self.q) * (self.part == part))] = 0
        free = np.isnan(p)
        k = self.laplacian(g)
        p[free] = np.linalg.solve(k[np.ix_(free, free)], self.q[free] - k[np.ix_(free, ~free)] @ p[~free])
        return g * (p[self.ends[:, 0]] - p[self.ends[:, 1]]), p


class Fields:
    """The fields of F.csv by segment of the network, which is found by its ends and its diameter."""

    def __init__(self, net, path):
        rows = list(csv.DictReader(line for line in open(path) if not line.startswith("#")))
        place = lambda r: tuple(round(float(r[c]) * 1e6) for c in ("x_mm", "y_mm", "z_mm"))
        node = {tuple(np.round(x * 1e6).astype(int)): k for k, x in enumerate(net.xyz)}
        by_id = {r["id"]: r for r in rows}
        left = {}
        for k, (a, b) in enumerate(net.ends):
            left.setdefault((min(a, b), max(a, b), round(net.um[k] * 5e3)), []).append(k)
        m = len(net.ends)
        self.flow, self.hematocrit, self.pressure = np.full(m, np.nan), np.full(m, np.nan), np.full(net.n, np.nan)
        value = lambda r, name: next((float(v) if v else np.nan for c, v in r.items() if c.split(" ")[0] == name), np.nan)
        self.rank = np.zeros(m, int)
        for row, r in enumerate(rows):
            end = node[place(r)]
            if not np.isnan(value(r, "pressure")):
                self.pressure[end] = value(r, "pressure") * MMHG
            if r["parent"] not in by_id:
                continue
            start = node[place(by_id[r["parent"]])]
            k = left[min(start, end), max(start, end), round(float(r["radius_mm"]) * 1e7)].pop(0)
            self.rank[k] = row
            size, direction = value(r, "flow"), value(r, "direction")
            assert size >= 0 and value(r, "wss") >= 0 and value(r, "velocity") >= 0 and direction in (-1, 0, 1)
            self.flow[k] = size / 0.06 * direction * (1 if net.ends[k][0] == start else -1)  # mm3/s
            self.hematocrit[k] = value(r, "hematocrit")
        assert not np.isnan(self.flow).any(), "a segment is missing"


def viscosity_pries(um, h, plasma, cells):
    d = um * (92 / cells) ** (1 / 3)
    s = 1 / (1 + 1e-11 * d**12)
    c = (0.8 + np.exp(-0.075 * d)) * (s - 1) + s
    m = 6 * np.exp(-0.085 * d) + 3.2 - 2.44 * np.exp(-0.06 * d**0.645)
    w = (d / (d - 1.1)) ** 2
    return plasma * 1e-3 * (1 + (m - 1) * ((1 - h) ** c - 1) / (0.55**c - 1) * w) * w


def shares(net, q, p, h0, rank):
    """The hematocrit of each segment, by falling pressure. Several outflows go by the order of the rows."""
    h = np.full(len(q), h0)
    out_of = lambda k, v: q[k] if net.ends[k][0] == v else -q[k]
    for v in sorted(range(net.n), key=lambda v: (-p[v], v)):
        at = sorted((k for k in range(len(q)) if v in net.ends[k]), key=lambda k: rank[k])
        ins, outs = [k for k in at if out_of(k, v) < 0], [k for k in at if out_of(k, v) > 0]
        enters = sum(out_of(k, v) for k in at)
        inner = not net.stated[v]
        cells = sum(abs(q[k]) * h[k] for k in ins)
        flow = sum(abs(q[k]) for k in ins)
        if not inner and enters > 0:
            cells += enters * (h0 if np.isnan(net.h[v]) else net.h[v])
            flow += enters
        left = sum(q_ for q_ in (out_of(k, v) for k in outs))
        cells *= left / flow if flow else 0
        feed = max((net.um[k] for k in ins), default=0)
        for a, b in zip(outs, outs[1:] + [None]):
            part = 1.0 if b is None else out_of(a, v) / left
            if b is not None and feed:
                d = (1 - cells / left) / max(feed, 4)
                r = (net.um[a] / net.um[b]) ** 2
                x = (part - PRIES[0] * d) / (1 - 2 * PRIES[0] * d)
                e = PRIES[2] * (r - 1) / (r + 1) * d + (1 + PRIES[1] * d) * np.log(x / (1 - x)) if 0 < x < 1 else 0
                part = 1 / (1 + np.exp(-e)) if 0 < x < 1 else float(x >= 1)
                feed = net.um[b]
            h[a] = part * cells / out_of(a, v)
            cells *= 1 - part
            left -= out_of(a, v)
    return h


def separation(net, rank, h0, plasma, cells):
    h, last, f = np.full(len(net.um), h0), 0, 1.0
    for i in range(1, 101):
        q, p = net.solve(viscosity_pries(net.um, h, plasma, cells))
        new = shares(net, q, p, h0, rank)
        done = np.abs(q - last).max() * 6e4 < 1e-3 and np.abs(new - h).max() < 1e-3
        if done:
            print("%d rounds" % i)
            return q, p, new
        h, last, f = h + f * (new - h), q, f * (0.8 if i % 5 == 0 else 1)
    sys.exit("flow.py: separation does not converge")


def estimate(net, viscosity, target, stress):
    g = np.pi * (net.um / 2e3) ** 4 / (8 * viscosity * net.length)
    k, n, m = net.laplacian(g), net.n, len(g)
    degree = np.bincount(net.ends.ravel(), minlength=n)
    opened = (degree == 1) & ~net.stated
    known = ~np.isnan(net.p)
    rows = np.flatnonzero(~opened & ~known)
    w = (np.bincount(net.ends[:, 0], net.length, n) + np.bincount(net.ends[:, 1], net.length, n)) / 2
    t = np.zeros((m, n))
    t[np.arange(m), net.ends[:, 0]] = net.um / 2e3 / (2 * net.length)
    t[np.arange(m), net.ends[:, 1]] = -net.um / 2e3 / (2 * net.length)
    sign = np.zeros(m)
    c = np.vstack([k[rows], np.eye(n)[known]])
    right = np.concatenate([net.q[rows], net.p[known]])
    scale = 1 / np.abs(c).max(axis=1)
    for weight in [0] + [0.002 * 2**i for i in range(12)]:
        kappa = weight * (10 * MMHG) ** 2
        for _ in range(5 if weight else 1):
            a = np.diag(w) + kappa * t.T @ (net.length[:, None] * t)
            b = w * target + kappa * t.T @ (net.length * sign * stress)
            whole = np.block([[a, (c * scale[:, None]).T], [c * scale[:, None], np.zeros((len(c), len(c)))]])
            p = np.linalg.solve(whole, np.concatenate([b, right * scale]))[:n]
            q = g * (p[net.ends[:, 0]] - p[net.ends[:, 1]])
            turned = (np.sign(q) != sign).any()
            sign = np.sign(q)
            if not turned:
                break
    return q, p


def compare(what, value, expected, tolerance):
    error = np.abs(value - expected).max()
    print("%s: largest difference %.3g of %.3g" % (what, error, np.abs(expected).max()))
    if not error <= tolerance * np.abs(expected).max():
        sys.exit("flow.py: %s differs by %.3g; at most %.3g is accepted" % (what, error, tolerance * np.abs(expected).max()))


def main(mode, path, fields=None, *numbers):
    if mode == "make":
        return make(path)
    net, numbers = Net(path), [float(x) for x in numbers]
    got = Fields(net, fields)
    if mode == "stored":
        wrong = (np.sign(net.stored) != np.sign(got.flow)).sum()
        error = np.abs(got.flow * 6e4 - net.stored).max()
        print("stored flow: largest difference %.4g nl/min, %d wrong directions of %d" % (error, wrong, len(net.um)))
        if wrong or error > 1.001e-3:
            sys.exit("flow.py: the flow differs by %.4g nl/min, %d directions are wrong" % (error, wrong))
    elif mode == "separation":
        q, p, h = separation(net, got.rank, *numbers)
        compare("flow", got.flow, q, 1e-9)
        compare("hematocrit", got.hematocrit, h, 1e-8)
        for part in set(net.part):
            at = net.part == part
            compare("pressure", got.pressure[at] - got.pressure[at].mean(), p[at] - p[at].mean(), 1e-9)
    else:
        q, p = estimate(net, numbers[0] * 1e-3, numbers[1] * MMHG, numbers[2])
        compare("flow", got.flow, q, 1e-7)
        compare("pressure", got.pressure, p, 1e-7)


main(*sys.argv[1:])
