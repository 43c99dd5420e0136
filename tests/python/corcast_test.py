"""Tests of corcast.py: numpy arrays in and out, options by name, the command line's bytes, errors.

Run by tests/command/python_test.sh with CORCAST (the program) and PYTHONPATH set, in a scratch
folder: python3 corcast_test.py.
"""

import json
import os
import pathlib
import subprocess
import threading
import unittest
import warnings

import numpy

import corcast

PROGRAM = os.environ["CORCAST"]


def run(*words):
    """Runs the command line; returns what it prints."""
    return subprocess.run([PROGRAM, *words, "--quiet"], check=True, capture_output=True).stdout


def data(path):
    return pathlib.Path(path).read_bytes()


class Trees(unittest.TestCase):
    def test_a_grown_tree_has_the_bytes_of_the_command_line(self):
        run("grow", "--terminals", "80", "--seed", "4", "--domain", "ball:30", "-o", "cli.swc")
        corcast.grow(terminals=80, seed=4, domain="ball:30").save("own.swc")
        self.assertEqual(data("own.swc"), data("cli.swc"))

    def test_arrays_describe_the_tree(self):
        tree = corcast.grow(terminals=50, seed=2)
        n = len(tree)
        self.assertEqual(n, 100)
        self.assertEqual((tree.positions.shape, tree.positions.dtype), ((n, 3), numpy.float64))
        self.assertEqual((tree.parents.shape, tree.parents.dtype), ((n,), numpy.int32))
        self.assertEqual(numpy.count_nonzero(tree.parents < 0), 1)
        self.assertTrue((tree.parents < numpy.arange(n)).all())
        self.assertTrue((tree.radii > 0).all())
        self.assertEqual(len(set(tree.ids)), n)

    def test_arrays_stay_when_the_tree_goes_or_changes(self):
        tree = corcast.grow(terminals=60, seed=2)
        positions = tree.positions
        kept = positions.copy()
        tree.refine(level="geometry")
        self.assertFalse((tree.positions == kept).all())
        del tree
        self.assertTrue((positions == kept).all())

    def test_fields_have_a_value_for_each_node_and_a_unit(self):
        tree = corcast.grow(terminals=50, seed=2)
        flow = tree.field("flow")
        self.assertEqual(flow.shape, (len(tree),))
        self.assertEqual(tree.unit("flow"), "ml/min")
        leaves = numpy.setdiff1d(numpy.arange(len(tree)), tree.parents)
        self.assertEqual(len(leaves), 50)
        self.assertTrue(numpy.allclose(flow[leaves], 10))

    def test_a_tree_of_arrays_is_the_tree_of_the_file(self):
        tree = corcast.grow(terminals=30, seed=3)
        again = corcast.Tree.from_arrays(tree.positions, tree.radii, tree.parents, tree.ids)
        for name in ("positions", "radii", "parents", "ids"):
            self.assertTrue((getattr(again, name) == getattr(tree, name)).all(), name)
        with self.assertRaisesRegex(ValueError, r"not \(n, 3\)"):
            corcast.Tree.from_arrays(tree.positions[:, :2], tree.radii, tree.parents)

    def test_a_tree_is_read_with_options(self):
        pathlib.Path("um.swc").write_text("1 2 0 0 0 2000 -1\n2 2 0 10000 0 2000 1\n")
        tree = corcast.read("um.swc", input_unit="um")
        self.assertTrue(numpy.allclose(tree.positions[1], (0, 10, 0)))
        self.assertTrue(numpy.allclose(tree.radii, 2))

    def test_refining_and_certifying_report_as_the_command_line(self):
        tree = corcast.grow(terminals=60, seed=5)
        tree.save("t.swc")
        report = tree.refine(level="topology")
        self.assertLess(report.target, report.target_before)
        run("refine", "t.swc", "--refine", "topology", "-o", "r.swc")
        again = corcast.read("r.swc")
        self.assertTrue(numpy.allclose(again.positions, tree.positions, atol=1e-4))
        self.assertTrue(0 <= tree.certify().gap < 0.01)
        self.assertEqual(tree.info().terminals, 60)


    def test_pulses_and_coverage_are_those_of_the_command_line(self):
        tree = corcast.grow(terminals=12, seed=3, domain="ball:20")
        tree.save("w.swc")
        report = tree.pulse(fields="wss,dilation", frames=4, q_perf=60)
        self.assertEqual(report, json.loads(run("pulse", "w.swc", "--q-perf", "60", "--json")))
        run("pulse", "w.swc", "--fields", "wss", "--frames", "4", "--q-perf", "60", "-o", "w.vtp")
        again = corcast.read("w.vtp")
        wss = tree.field("wss_0.25")
        self.assertTrue(numpy.array_equal(wss, again.field("wss_0.25"), equal_nan=True))
        self.assertGreater(numpy.nanmin(wss), 0)
        self.assertEqual(tree.unit("wss_0.25"), "Pa")
        tree.render(size=(40, 40), color_by="wss", moment=2, beat=5)
        covered = tree.coverage(spacing=2)
        run("coverage", "w.swc", "--spacing", "2", "--json", "c.json")
        self.assertEqual(covered.mean_mm, json.loads(pathlib.Path("c.json").read_text())["mean_mm"])

    def test_flow_is_that_of_the_command_line(self):
        tree = corcast.grow(terminals=12, seed=3, domain="ball:20")
        tree.save("w.swc")
        report = tree.flow(q_perf=60)
        self.assertEqual(report, json.loads(run("flow", "w.swc", "--q-perf", "60", "--json")))
        self.assertAlmostEqual(report.inflow, 60)
        self.assertEqual(tree.unit("wss"), "Pa")

    def test_an_answer_grades_a_picture(self):
        tree = corcast.grow(terminals=12, seed=3)
        self.assertLess(tree.answer("t.answer.exr", size=(60, 40)).undecided, 240)
        tree.render(size=(60, 40), exact=True, antialias=1).save("t.png")
        run("compare", "t.answer.exr", "t.png")


class Pictures(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.tree = corcast.grow(terminals=60, seed=1)
        cls.tree.save("p.swc")

    def test_pictures_of_all_models_have_the_pixels_of_the_command_line(self):
        for model in ("rounded", "joined", "isosurface", "blob"):
            run("render", "p.swc", "--model", model, "--size", "120x90", "-o", "cli.png")
            image = self.tree.render(model=model, size=(120, 90))
            self.assertEqual(image.size, (120, 90))
            self.assertTrue((image.pixels == corcast.Image.read("cli.png").pixels).all(), model)
            self.assertTrue(corcast.compare("cli.png", image).agrees)

    def test_planes_come_with_the_picture(self):
        image = self.tree.render(size=(80, 60), planes="depth,normal,id")
        depth, normal, ids = image.plane("depth"), image.plane("normal"), image.plane("id")
        seen = numpy.isfinite(depth)
        self.assertTrue(seen.any() and not seen.all())
        self.assertTrue(numpy.allclose(numpy.linalg.norm(normal[seen], axis=1), 1, atol=1e-5))
        self.assertTrue((ids[seen] > 0).all() and (ids[~seen] == 0).all())
        self.assertIsNone(self.tree.render(size=(20, 20)).plane("depth"))

    def test_an_array_becomes_a_picture_and_comes_back(self):
        for dtype, most in ((numpy.uint8, 255), (numpy.uint16, 65535)):
            pixels = (numpy.arange(4 * 5 * 3).reshape(4, 5, 3) * (most // 60)).astype(dtype)
            image = corcast.Image.from_array(pixels)
            self.assertTrue((image.plane("color", dtype) == pixels).all())
        image.save("array.png", dtype=numpy.uint16)
        self.assertTrue((corcast.Image.read("array.png").plane("color", numpy.uint16)
                         == pixels).all())

    def test_files_in_memory_are_those_that_save_writes(self):
        image = self.tree.render(size="40x30", planes="depth")
        for name, plane in (("a.png", "color"), ("a.exr", "depth"), ("a.tif", "color")):
            image.save(name, plane)
            content = image.to_bytes(name, plane)
            self.assertEqual(content, data(name))
            again = corcast.Image.from_bytes(content, name)
            numpy.testing.assert_array_equal(
                again.plane("color", numpy.float32 if plane == "depth" else None),
                image.plane(plane))
        with self.assertRaisesRegex(corcast.Error, "mine: is not an image"):
            corcast.Image.from_bytes(b"abc", "mine")

    def test_a_comparison_names_what_differs(self):
        a = self.tree.render(size=(80, 60))
        found = corcast.compare(a, corcast.Image.from_array(a.pixels[::-1]))
        self.assertFalse(found.agrees)
        self.assertIn("flipped top to bottom", found.cause)

    def test_a_notebook_shows_trees_pictures_and_pages(self):
        self.assertTrue(self.tree._repr_png_().startswith(b"\x89PNG"))
        self.assertTrue(self.tree.render(size=(20, 20))._repr_png_().startswith(b"\x89PNG"))
        page = self.tree.page()
        self.assertIn("<iframe", page._repr_html_())
        self.assertIn("<!DOCTYPE html>", page.html[:200])


class Files(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        corcast.grow(terminals=40, seed=1).save("f.swc")
        cls.tree = corcast.read("f.swc")  # files name the tree's file in the command that made them

    def test_exports_have_the_bytes_of_the_command_line(self):
        for name, command in (("m.stl", "export"), ("m.glb", "export"), ("s.pov", "scene"),
                              ("s.scad", "scene"), ("d.svg", "diagram")):
            run(command, "f.swc", "-o", name)
            line = data(name)
            os.rename(name, "of-line-" + name)
            self.tree.export(name, command=command)
            self.assertEqual(data(name), line, name)
            self.assertEqual(self.tree.export_bytes(name, command=command)[name], line, name)

    def test_a_mesh_is_closed(self):
        mesh = self.tree.mesh()
        edges = numpy.sort(mesh.triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
        _, uses = numpy.unique(edges, axis=0, return_counts=True)
        self.assertTrue((uses == 2).all())
        a, b, c = (mesh.vertices[mesh.triangles[:, k]] for k in range(3))
        self.assertGreater(numpy.einsum("ij,ij->i", a, numpy.cross(b, c)).sum(), 0)
        self.assertLess(mesh.segments.max(), len(self.tree))

    def test_the_schema_has_every_option_of_the_help(self):
        import re
        schema = corcast.schema("grow")
        names = {option["name"] for option in schema["options"]}
        shown = set(re.findall(r"^\s+--([a-z][a-z-]+)", run("grow", "--help").decode(), re.M))
        self.assertTrue(shown and shown <= names, shown - names)


class Faults(unittest.TestCase):
    def test_an_error_has_the_sentence_and_status_of_the_command_line(self):
        for arguments, words in (({"terminals": 0}, ("--terminals", "0")),
                                 ({"gamma": "x"}, ("--gamma", "x")),
                                 ({"terminal": 5}, ("--terminal", "5"))):
            line = subprocess.run([PROGRAM, "grow", *words, "-o", "no.swc"], capture_output=True,
                                  text=True, check=False)
            with self.assertRaises(corcast.Error) as caught:
                corcast.grow(**arguments)
            self.assertEqual(caught.exception.exit_status, line.returncode)
            self.assertIn(str(caught.exception), line.stderr)
            self.assertEqual(caught.exception.kind, "usage")

    def test_a_file_that_is_missing_is_named(self):
        with self.assertRaisesRegex(corcast.Error, "missing.swc") as caught:
            corcast.read("missing.swc")
        self.assertEqual(caught.exception.exit_status, 2)

    def test_progress_is_told_and_stops_the_work(self):
        steps = []
        corcast.grow(terminals=300, progress=lambda step, fraction: steps.append((step, fraction)))
        self.assertEqual(steps[0], ("growing", 0.0))
        with self.assertRaises(corcast.Error) as caught:
            corcast.grow(terminals=3000, progress=lambda step, fraction: fraction < 0.2)
        self.assertEqual(caught.exception.kind, "cancelled")

    def test_what_a_callback_raises_reaches_the_caller(self):
        def interrupt(step, fraction):
            raise KeyboardInterrupt
        with self.assertRaises(KeyboardInterrupt):
            corcast.grow(terminals=3000, progress=interrupt)

    def test_warnings_of_the_library_are_warnings_of_python(self):
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            corcast.grow(terminals=600, domain="disc:1")
        self.assertIn("vessels were kept apart with", str(caught[0].message))

    def test_wrong_integers_copies_and_numpy_answers(self):
        import copy
        import pickle
        tree = corcast.grow(terminals=20)
        for parents in ([-1, 2 ** 32], [-1, 0.5]):
            with self.assertRaisesRegex(ValueError, "parents are not integers"):
                corcast.Tree.from_arrays([(0, 0, 0), (0, 1, 0)], [1, 1], parents)
        other = copy.copy(tree)
        self.assertTrue((other.positions == tree.positions).all())
        del other
        self.assertEqual(len(tree), 40)
        with self.assertRaises(TypeError):
            pickle.dumps(tree)
        error = pickle.loads(pickle.dumps(corcast.Error("a", 2, "usage")))
        self.assertEqual((str(error), error.exit_status), ("a", 2))
        with self.assertRaises(corcast.Error):
            corcast.grow(terminals=3000, progress=lambda step, fraction: numpy.bool_(False))
        image = tree.render(size=(20, 20), planes=["depth", "id"])
        self.assertIsNotNone(image.plane("depth"))
        self.assertIsNotNone(image.plane("id"))

    def test_options_are_reset_and_flags_are_switched_off(self):
        tree = corcast.grow(terminals=20, partial=False, seed=3)
        self.assertTrue((tree.positions == corcast.grow(terminals=20, seed=3).positions).all())
        with self.assertRaisesRegex(corcast.Error, "floats are written to .exr"):
            tree.render(size=(20, 20), planes="depth").save("depth.png", plane="depth")
        with self.assertRaisesRegex(corcast.Error, "ids are written to"):
            tree.render(size=(20, 20), planes="id").save("id.tif", plane="id")
        tree.export("converted.vtp", command="convert", fields="flow")
        self.assertEqual(len(corcast.read("converted.vtp")), 40)

    def test_threads_share_a_tree(self):
        tree = corcast.grow(terminals=200)
        expected = {name: tree.field(name) for name in ("flow", "wss", "pressure")}
        wrong = []

        def work():
            for k in range(60):
                name = list(expected)[k % 3]
                if not numpy.array_equal(tree.field(name), expected[name], equal_nan=True):
                    wrong.append(name)

        threads = [threading.Thread(target=work) for _ in range(6)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(wrong, [])

    def test_threads_use_the_library_side_by_side(self):
        made = {}

        def work(seed):
            made[seed] = corcast.grow(terminals=100, seed=seed, threads=1).positions

        threads = [threading.Thread(target=work, args=(seed,)) for seed in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        for seed, positions in made.items():
            self.assertTrue((positions == corcast.grow(terminals=100, seed=seed).positions).all())


if __name__ == "__main__":
    unittest.main(verbosity=2)
