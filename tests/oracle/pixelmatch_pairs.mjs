// Writes pairs of pictures, and the counts of the npm package pixelmatch: node pixelmatch_pairs.mjs MODULES
//
// Pair I is I.a.png and I.b.png. The file `expected` has a line per pair and threshold: I THRESHOLD COUNT.
import { createRequire } from "node:module";
import { writeFileSync } from "node:fs";
const modules = process.argv[2];
const { default: pixelmatch } = await import(modules + "/pixelmatch/index.js");
const { PNG } = createRequire(modules + "/")("pngjs");

let state = 2385;
function below(n) {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    return Math.floor((state / 2 ** 32) * n);
}
const pick = list => list[below(list.length)];

// Alphas of a pair: none, a few, any.
const alphas = [() => 255, () => pick([0, 255]), () => pick([0, 128, 255]), () => below(256)];

// Discs on a ground, their edges smoothed by 3 x 3 samples or not: the pictures whose edges pixelmatch looks for.
function discs(width, height, alpha, smooth, shift, copy) {
    const list = copy || Array.from({ length: 3 }, () => [below(width), below(height), 1 + below(6), below(256), below(256), below(256), alpha()]);
    const ground = list.ground ||= [below(256), below(256), below(256), alpha()];
    const data = Buffer.alloc(4 * width * height);
    const n = smooth ? 3 : 1;
    for (let y = 0; y < height; y++)
        for (let x = 0; x < width; x++) {
            const sum = [0, 0, 0, 0];
            for (let k = 0; k < n * n; k++) {
                const u = x + shift + ((k % n) + 0.5) / n, v = y + (Math.floor(k / n) + 0.5) / n;
                const hit = list.find(([cx, cy, r]) => (u - cx) ** 2 + (v - cy) ** 2 < r * r);
                (hit ? hit.slice(3) : ground).forEach((value, c) => (sum[c] += value / (n * n)));
            }
            sum.forEach((value, c) => (data[4 * (y * width + x) + c] = Math.round(value)));
        }
    return { data, list };
}

// Few colors at random: pixels with none, one, two, three and more siblings, darker and brighter neighbours.
function grain(width, height, alpha, colors) {
    const palette = Array.from({ length: colors }, () => [below(256), below(256), below(256), alpha()]);
    return Buffer.from(Array.from({ length: width * height }, () => pick(palette)).flat());
}

// Some pixels of another picture get the color of a neighbour, or one of their own.
function disturb(data, width, alpha, one_in) {
    const made = Buffer.from(data), n = data.length / 4;
    for (let i = 0; i < n; i++) {
        if (below(one_in)) continue;
        const from = (i + pick([1, width, n - 1, n - width])) % n;
        if (below(2)) data.copy(made, 4 * i, 4 * from, 4 * from + 4);
        else made.set([below(256), below(256), below(256), alpha()], 4 * i);
    }
    return made;
}

const sizes = [[24, 17], [31, 9], [1, 8], [8, 1], [2, 2], [3, 3], [5, 4]];
let expected = "";
for (let i = 0; i < 84; i++) {
    const [width, height] = sizes[i < 56 ? i % 2 : i % sizes.length], alpha = alphas[i % 4];
    let a, b;
    if (i % 3 == 0) {
        const drawn = discs(width, height, alpha, i % 2, 0);
        a = drawn.data;
        b = discs(width, height, alpha, i % 4 < 2, pick([0, 0.3, 1]), drawn.list).data;
    } else {
        a = grain(width, height, alpha, 2 + (i % 4));
        b = disturb(a, width, alpha, 2 + (i % 7));
    }
    for (const [name, data] of [["a", a], ["b", b]])
        writeFileSync(`${i}.${name}.png`, PNG.sync.write({ width, height, data }));
    const threshold = pick([0, 0.02, 0.1, 0.3]);
    expected += `${i} ${threshold} ${pixelmatch(a, b, undefined, width, height, { threshold })}\n`;
}
writeFileSync("expected", expected);
