#!/usr/bin/env python3
"""Writes a tree that is sampled from a published table, as SWC on standard output.

    sampled_tree.py TABLE LOWEST SEED

TABLE is a file of templates/morphometry, and LOWEST the lowest order of the tree. Nothing of corcast
is used. An element of order n has floor(C) or floor(C) + 1 daughters of each order, C being the
published mean, by chance. Its diameter is normal within the bounds of its order, and its length
lognormal. Daughters branch off one by one in a random order; if two or more are of lower orders, two
of these end the element. The segments between have exponential shares of its length. Directions are
random, so vessels overlap.
"""
import math
import random
import sys


def read_table(path):
    """Rows of numbers, and the mean daughters by order. A length that is not published grows by the published ratio."""
    rows, daughters, growth = [], {}, math.nan
    for line in open(path):
        words = line.split()
        if words and words[0] == 'ratios':
            growth = float(words[3])
        if words and words[0].isdigit():
            rows.append([float(word) for word in words])
        elif words and words[0] == 'daughters':
            daughters[int(words[1])] = [float(word) for word in words[2::2]]
    for below, row in zip(rows, rows[1:]):
        if math.isnan(row[3]):
            row[3] = below[3] * growth
    return rows, daughters


class Sampler:
    def __init__(self, path, lowest, seed):
        self.rows, self.daughters = read_table(path)
        self.lowest = lowest
        self.random = random.Random(seed)
        self.nodes = []

    def bound(self, order):
        """The diameter between `order` and the next, um."""
        low, high = self.rows[order - 1], self.rows[order]
        deviation = 0 if math.isnan(high[2]) else high[2]
        return (low[1] + low[2] + high[1] - deviation) / 2

    def diameter(self, order):
        mean, deviation = self.rows[order - 1][1:3]
        if math.isnan(deviation):
            return mean
        least = self.bound(order - 1) if order > 1 else 0
        most = self.bound(order) if order < len(self.rows) else math.inf
        while True:
            value = self.random.gauss(mean, deviation)
            if least < value < most:
                return value

    def length(self, order):
        mean, deviation = self.rows[order - 1][3:5]
        if math.isnan(deviation):
            return mean
        variance = math.log1p((deviation / mean) ** 2)
        return self.random.lognormvariate(math.log(mean) - variance / 2, math.sqrt(variance))

    def draw_daughters(self, order):
        """The orders of an element's daughters, from its start to its end."""
        drawn = []
        for less, mean in enumerate(self.daughters[order]):
            if order - less >= self.lowest:
                count = math.floor(mean) + (self.random.random() < mean % 1)
                drawn += [order - less] * count
        self.random.shuffle(drawn)
        ends = [i for i, daughter in enumerate(drawn) if daughter != order][-2:]
        return [daughter for i, daughter in enumerate(drawn) if i not in ends] + [drawn[i] for i in ends]

    def add_node(self, parent, length, radius):
        direction = [self.random.gauss(0, 1) for _ in range(3)]
        scale = length / math.hypot(*direction)
        place = [at + scale * d for at, d in zip(self.nodes[parent][0], direction)]
        self.nodes.append((place, radius, parent))
        return len(self.nodes) - 1

    def add_element(self, order, node):
        """Adds an element's segments behind `node`, and returns the orders and nodes of its daughters."""
        radius = self.diameter(order) / 2000
        if not self.nodes:
            self.nodes.append(([0, 0, 0], radius, -1))
        daughters = self.draw_daughters(order)
        ends_in_two = sum(daughter != order for daughter in daughters) >= 2
        shares = [self.random.expovariate(1) for _ in range(len(daughters) + (-1 if ends_in_two else 1))]
        length = self.length(order) / sum(shares)
        nodes = []
        for share in shares:
            node = self.add_node(node, share * length, radius)
            nodes.append(node)
        return [(daughter, nodes[min(i, len(nodes) - 1)]) for i, daughter in enumerate(daughters)]

    def sample(self):
        waiting = [(len(self.rows), 0)]
        while waiting:
            waiting += self.add_element(*waiting.pop())


def main():
    path, lowest, seed = sys.argv[1], int(sys.argv[2]), int(sys.argv[3])
    sampler = Sampler(path, lowest, seed)
    sampler.sample()
    for i, (place, radius, parent) in enumerate(sampler.nodes):
        x, y, z = (f'{value:.9g}' for value in place)
        print(i + 1, 3, x, y, z, f'{radius:.9g}', parent + 1 if parent >= 0 else -1)


main()
