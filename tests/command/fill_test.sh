#!/usr/bin/env bash
# `grow --fill`: small vessels drawn from a published table, in a tree of large vessels.
. "$(dirname "$0")/../lib.sh"

grow_skeleton() {
    run_ok corcast grow --domain ball:9 --terminals 7 --gamma 2.3 --p-term 95 --q-perf 20 --seed 3 -o skeleton.swc
}

# The last stage of two.
write_stages() {
    cat >stages.ini <<'END'
[large]
domain = ball:9
terminals = 7
gamma = 2.3
p-term = 95
q-perf = 20
[small]
fill = kassab-lad
fill-to = 4
p-term = 60
END
}

# count_faults TREE SCALE: the number of segments of TREE that, with SCALE times their radii, are shorter than wide or
# too near to a segment that they share no node with; of two, the one that comes later. Segments with a radius of
# skeleton.swc are its pieces, which are not counted.
count_faults() {
    awk -v scale="$2" '
        function dot(a, b) { return a[1] * b[1] + a[2] * b[2] + a[3] * b[3] }
        function clamp(x) { return x < 0 ? 0 : x > 1 ? 1 : x }
        function distance(i, j,   k, u, v, w, uu, vv, uv, uw, vw, den, s, t, sum) {
            for (k = 1; k <= 3; k++) {
                u[k] = at[i, k] - at[parent[i], k]; v[k] = at[j, k] - at[parent[j], k]
                w[k] = at[parent[i], k] - at[parent[j], k]
            }
            uu = dot(u, u); vv = dot(v, v); uv = dot(u, v); uw = dot(u, w); vw = dot(v, w)
            den = uu * vv - uv * uv
            s = den > 0 ? clamp((uv * vw - uw * vv) / den) : 0
            t = (uv * s + vw) / vv
            if (t != clamp(t)) { t = clamp(t); s = clamp((uv * t - uw) / uu) }
            for (k = 1; k <= 3; k++) sum += (w[k] + u[k] * s - v[k] * t) ^ 2
            return sqrt(sum)
        }
        /^#/ { next }
        FNR == NR { large[$6]; next }
        { n++; id[n] = $1; parent[$1] = $7; if ($6 in large) grown[$1]; radius[$1] = scale * $6; for (k = 1; k <= 3; k++) at[$1, k] = $(2 + k) }
        END {
            for (x = 1; x <= n; x++) for (y = 1; y < x; y++) {
                i = id[x]; j = id[y]
                if (parent[i] < 0 || parent[j] < 0 || (i in grown && j in grown)) continue
                if (parent[i] == parent[j] || parent[i] == j || parent[j] == i) continue
                if (distance(i, j) < (radius[i] + radius[j]) * (1 - 1e-9)) bad[i in grown ? j : i]
            }
            for (x = 1; x <= n; x++) {
                i = id[x]; sum = 0
                if (parent[i] < 0 || i in grown) continue
                for (k = 1; k <= 3; k++) sum += (at[i, k] - at[parent[i], k]) ^ 2
                if (sqrt(sum) < 2 * radius[i] * (1 - 1e-9)) bad[i]
            }
            for (i in bad) count++
            print count + 0
        }' skeleton.swc "$1"
}

test_a_filled_tree_keeps_the_large_vessels_and_is_clear_in_its_domain() {
    grow_skeleton
    run_ok corcast grow --from skeleton.swc --fill kassab-lad --fill-to 4 --p-term 60 --seed 5 -o tree.swc --json tree.json
    awk '/^#/ { next } FNR == NR { at[$1] = $3 " " $4 " " $5 " " $6; next } { seen[$1] = $3 " " $4 " " $5 " " $6 }
         END { for (id in at) bad += seen[id] != at[id]; exit bad > 0 }' skeleton.swc tree.swc ||
        fail "expected the nodes and radii of the skeleton"
    awk '!/^#/ && $3 * $3 + $4 * $4 + $5 * $5 > 81.0001 { exit 1 }' tree.swc || fail "expected all vessels in the ball"
    expect_json tree.json '.fill.elements > 200 and .fill.left_out == 0 and .fill.flow_spread > 0.1 and .target == null'
    local faults
    faults=$(count_faults tree.swc 1)
    [ "$faults" -eq "$(jq .broken tree.json)" ] || fail "expected $(jq .broken tree.json) broken segments, found $faults"
    [ "$(count_faults tree.swc 6)" -gt 30 ] || fail "expected the count to find vessels that overlap"
    grep -qx '# fill: kassab-lad, orders 4 to 6' tree.swc || fail "expected the table in the header"
    ! grep -q '^# gamma\|^# lambda' tree.swc || fail "expected no law of growth in the header"
}

# Pressures are those of the flows in the header, by Poiseuille's law, which info computes on its own.
test_all_terminals_of_a_filled_tree_are_at_one_pressure() {
    write_stages
    run_ok corcast grow --stages stages.ini --seed 5 -o tree.swc
    run_ok corcast info tree.swc --json
    expect_json stdout '(.terminal_pressure_mmHg | .min - 60 | fabs) < 1e-9 and (.terminal_pressure_mmHg | .max - 60 | fabs) < 1e-9'
    run_ok corcast grow --stages stages.ini --seed 5 --threads 3 -o again.swc
    expect_same <(grep -v '^# command' tree.swc) <(grep -v '^# command' again.swc)
    run_ok corcast grow --stages stages.ini --seed 6 -o other.swc
    ! cmp -s tree.swc other.swc || fail "expected another tree of another seed"
}

test_a_filling_that_cannot_be_is_refused_in_one_sentence() {
    grow_skeleton
    local options sentence change
    while IFS='|' read -r options sentence; do
        # shellcheck disable=SC2086
        run corcast grow --quiet -o tree.swc $options
        expect_status 2
        expect_sentence "$sentence"
    done <<'END'
--fill kassab-lad|--fill needs --from or --stages
--from skeleton.swc --fill kassab|--fill: 'kassab' is unknown; available: kassab-lad
--from skeleton.swc --fill kassab-lad --fill-from 12|--fill-from is 12; it must be from 2 to 11, the highest order of kassab-lad
--from skeleton.swc --fill kassab-lad --fill-to 7|--fill-to is 7; it must be from 1 to 6, below --fill-from
--from skeleton.swc --fill kassab-lad --fill-from 1|--fill-from: '1' is not an integer from 2 to 100
--from skeleton.swc --fill kassab-lad --domain disc:20|--fill: the domain has two dimensions; it must have three, because published tables describe vessels in three dimensions
--from skeleton.swc --terminals 50 --fill-to 3|--fill-to needs --fill or --stages
END
    while IFS='|' read -r change sentence; do
        write_stages
        sed -i "$change" stages.ini
        run corcast grow --stages stages.ini --quiet -o tree.swc
        expect_status 2
        expect_sentence "$sentence"
    done <<'END'
$a [more]\nterminals = 90|stages.ini: \[more\]: the stage before it, \[small\], has the option fill, which only the last stage may have
s/^fill = .*/fill = kassab/|stages.ini: \[small\]: --fill: 'kassab' is unknown
s/^fill-to = .*/fill-to = 7/|stages.ini: \[small\]: --fill-to is 7; it must be from 1 to 6, below --fill-from
/^.large/,/^q-perf/d|stages.ini: \[small\]: --fill needs --from, the tree to be filled
END
}

run_tests "$@"
