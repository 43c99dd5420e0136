#!/usr/bin/env python3
"""check_certificate.py T.swc CERTIFICATE: whether the certificate proves that no tree of T's topology, with
its inlets and outlets, their flows and its drops of pressure from inlet to outlet, or less, has a target
below the bound that it says [docs/METHODS.md 1.5]. In exact fractions; exit 1 when it does not."""
import hashlib
import sys
from fractions import Fraction
from math import isqrt

FINE = 2**256  # a drop is rounded up to a multiple of 1 / FINE


def ceiling_of_root(square):
    return Fraction(isqrt(square.numerator * FINE**2 // square.denominator) + 1, FINE)


def check(tree_path, certificate_path):
    body, digest = open(certificate_path, "rb").read().rsplit(b"# sha256: ", 1)
    assert hashlib.sha256(body).hexdigest() == digest.decode().strip(), "its SHA-256 is another"
    lines = body.decode().splitlines()
    said = dict(line[2:].split(": ") for line in lines if ": " in line)
    power, bound = Fraction(said["lambda"]) / 4, Fraction(said["bound"])
    assert power > 0, "lambda is not above 0"
    outlet = {int(line.split()[0]): [Fraction(word) for word in line.split()[1:]] for line in lines if line[0] != "#"}
    rows = [line.split()[:7] for line in open(tree_path) if line.strip() and line[0] != "#"]
    node = {int(row[0]): ([Fraction(word) for word in row[2:5]], Fraction(row[5]), int(row[6])) for row in rows}
    assert all(values[0] > 0 and values[4] >= 0 for values in outlet.values()), "a flow or charge is below 0"
    below = {i: outlet.pop(i, [Fraction(0)] * 5) for i in node}  # flow, pull, charge: at first there
    assert not outlet, "it has an outlet that the tree has not"
    proved = Fraction(0)
    for i in reversed(node):
        place, radius, parent = node[i]
        flow, *pull, charge = below.pop(i)
        if parent < 0 or flow == 0:
            continue
        assert parent in below, f"node {parent} comes after its child"
        below[parent] = [a + b for a, b in zip(below[parent], (flow, *pull, charge))]
        way = [a - b for a, b in zip(place, node[parent][0])]
        drop = flow * ceiling_of_root(sum(x * x for x in way)) / radius**4
        proved += sum(a * b for a, b in zip(pull, way)) - charge * Fraction(-(-drop.numerator * FINE // drop.denominator), FINE)
        # |pull| <= (1 + a) (flow charge / a)^(a / (1 + a)), both to the power of twice the denominator
        up, down = power.numerator, (1 + power).numerator
        left = sum(x * x for x in pull) / (1 + power) ** 2
        assert left**down <= (flow * charge / power) ** (2 * up), f"the pull on segment {i} is too large"
    assert proved >= bound, f"it proves {float(proved)} only, and says {float(bound)}"
    return bound


try:
    print(f"proved: the target is at least {float(check(*sys.argv[1:])):.12g}")
except AssertionError as error:
    sys.exit(f"{sys.argv[2]}: {error}")
except (OSError, ValueError, KeyError, IndexError, ZeroDivisionError) as error:
    sys.exit(f"{sys.argv[2]}: not a certificate of {sys.argv[1]}: {error!r}")
