#!/usr/bin/env bash
# Networks in XML: files of other programs, and of the libraries that write such files.
. "$(dirname "${BASH_SOURCE[0]}")/../lib.sh"

test_trees_of_vascusynth_and_opencco_have_their_terminals() {
    local tree='.bifurcations == .terminals - 1 and .roots == 1 and .reading.network.loops == 0'
    expect_tree peers/opencco_2d_100.xml ".terminals == 100 and $tree"
    expect_tree peers/opencco_3d_100.xml ".terminals == 100 and $tree"
    expect_tree peers/vascusynth_100.xml ".terminals == 100 and $tree"
    expect_tree vascusynth_gxl/ftilde_tree_structure.xml ".terminals == 1000 and $tree"
    expect_tree vascusynth_gxl/tree_structure_from_OpenCCO_Figure6.xml ".terminals == 200 and $tree"
}

test_a_grown_tree_comes_back_from_gxl_and_graphml() {
    local format
    grow_tree 60
    for format in gxl graphml; do
        run_ok corcast convert tree.swc tree.$format
        xmllint --noout tree.$format || fail "xmllint refuses the $format"
        run_ok corcast convert tree.$format back.swc
        expect_same tree.swc back.swc
    done
}

PYTHON=/usr/bin/python3

test_networkx_and_igraph_read_our_graphml() {
    $PYTHON -c 'import networkx, igraph' || skip "networkx or igraph is not installed"
    grow_tree 30
    run_ok corcast convert tree.swc tree.graphml
    $PYTHON - <<'END' || fail "networkx and igraph have not the tree"
import igraph, networkx
rows = [line.split() for line in open("tree.swc") if line[0] != "#"]
n = networkx.read_graphml("tree.graphml")
assert n.is_directed() and n.number_of_nodes() == len(rows) == 60 and n.number_of_edges() == 59
i = igraph.Graph.Read_GraphML("tree.graphml")
assert i.vcount() == 60 and i.ecount() == 59
for k, row in enumerate(rows):
    node = n.nodes["n" + row[0]]
    assert [node[c] for c in ("X", "Y", "Z", "radius")] == [float(v) for v in row[2:6]]
    assert [i.vs[k][c] for c in ("X", "Y", "Z", "radius")] == [float(v) for v in row[2:6]]
    if row[6] != "-1":
        assert n.edges["n" + row[6], "n" + row[0]]["radius"] == float(row[5])
END
}

test_graphs_that_networkx_and_igraph_write_are_read() {
    $PYTHON -c 'import networkx, igraph' || skip "networkx or igraph is not installed"
    $PYTHON - <<'END'
import igraph, networkx
place = [(0.5, 1, 2), (4, 1.25, 2), (7, 4, 2), (6, -3, 2.385)]
edges = [(0, 1, 0.5), (1, 2, 0.375), (1, 3, 0.25)]
n = networkx.Graph()
for k, (x, y, z) in enumerate(place):
    n.add_node(k, x=x, y=y, z=z)
for a, b, r in edges:
    n.add_edge(a, b, radius=r, artery=True, name="a text")
networkx.write_graphml(n, "networkx.graphml")
i = igraph.Graph(edges=[e[:2] for e in edges])
for k, axis in enumerate("XYZ"):
    i.vs[axis] = [p[k] for p in place]
i.es["radius_avg"] = [e[2] for e in edges]
i.write_graphml("igraph.graphml")
END
    local file
    printf '1 3 0.5 1 2 0.5 -1\n2 3 4 1.25 2 0.5 1\n3 3 7 4 2 0.375 2\n4 3 6 -3 2.385 0.25 2\n' >expected
    for file in networkx igraph; do
        run_ok corcast convert --quiet $file.graphml $file.swc
        grep -v '^#' $file.swc >rows
        expect_same rows expected
    done
}

run_tests "$@"
