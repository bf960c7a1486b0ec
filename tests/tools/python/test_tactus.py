# SPDX-License-Identifier: Apache-2.0
"""tactus in Python, each test named as a claim. Run by ctest with the library and the command of the build."""

import gc
import json
import os
import pathlib
import resource
import socket
import subprocess
import sys
import tempfile
import threading
import time
import unittest
import wave

import numpy as np

import tactus

COMMAND = os.environ["TACTUS_COMMAND"]


def recorded(folder, *arguments):
    subprocess.run([COMMAND, "render", "touch-sphere", "--seconds", "1", "--out", f"{folder}/out", "--record",
                    f"{folder}/take", *arguments], check=True, capture_output=True)
    return f"{folder}/take"


class Takes(unittest.TestCase):
    def test_values_are_those_of_the_csv_that_the_run_wrote(self):
        with tempfile.TemporaryDirectory() as folder:
            take = tactus.open(recorded(folder))
            force = take["coupling.wrench"]
            csv = np.loadtxt(f"{folder}/out/force.csv", delimiter=",", skiprows=1)
            self.assertEqual(force.names, ["fx", "fy", "fz", "tx", "ty", "tz"])
            self.assertEqual(force.values.shape, (1000, 6))
            np.testing.assert_allclose(force.values, csv[:, 1:], rtol=1e-5, atol=1e-9)
            np.testing.assert_allclose(force.t, csv[:, 0], atol=1e-9)
            np.testing.assert_array_equal(force["fz"], force.values[:, 2])
            self.assertFalse(force.values.flags.writeable)
            self.assertIn("coupling.wrench", take._repr_html_())
            self.assertTrue(take.replay())

    def test_a_changed_bit_is_seen_by_replay(self):
        with tempfile.TemporaryDirectory() as folder:
            name = recorded(folder)
            stream = next(pathlib.Path(name).glob("streams/*.wav"))
            data = bytearray(stream.read_bytes())
            data[-9] ^= 1
            stream.write_bytes(data)
            self.assertFalse(tactus.open(name).replay())

    def test_a_large_take_is_mapped_not_read(self):
        with tempfile.TemporaryDirectory() as folder:
            name = pathlib.Path(recorded(folder))
            stream = next(name.glob("streams/*.wav"))
            with stream.open("r+b") as file:  # as a run that was killed leaves it: more samples than the header says
                file.truncate(1 << 30)
            before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
            values = tactus.open(name)["coupling.wrench"].values
            self.assertLess(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before, 20_000)
            self.assertGreaterEqual(len(values), 1000)

    def test_a_folder_that_is_no_take_says_so(self):
        with self.assertRaisesRegex(tactus.Error, "no take"):
            tactus.open("/tmp")
        with tempfile.TemporaryDirectory() as folder:
            with self.assertRaisesRegex(KeyError, "coupling.wrench"):
                tactus.open(recorded(folder))["nothing.here"]


class Patches(unittest.TestCase):
    def test_a_render_has_the_bits_of_the_command(self):
        with tempfile.TemporaryDirectory() as folder:
            take = tactus.open(recorded(folder))
            done = tactus.load("touch-sphere").render(1.0)
            self.assertIn(done.hash, (pathlib.Path(folder) / "out/summary.json").read_text())
            for port in ("coupling.wrench", "place.pose"):
                np.testing.assert_array_equal(done[port].values, take[port].values)
                np.testing.assert_array_equal(done[port].t, take[port].t)

    def test_arrays_outlive_the_patch_and_the_run(self):
        values = tactus.load("touch-sphere").render(0.2)["coupling.pose"].values
        copy = values.copy()
        gc.collect()
        np.testing.assert_array_equal(values, copy)
        with self.assertRaises(ValueError):
            values[0, 0] = 1.0

    def test_settings_and_a_sweep_change_what_is_computed(self):
        patch = tactus.load("touch-sphere")
        rows = list(patch.sweep({"coupling.stiffness": ["0.2 N/mm", "0.5 N/mm", "1 N/mm"]}, 1.0, jobs=2,
                                outputs=["coupling.wrench"]))
        peaks = [np.abs(done["coupling.wrench"]["fz"]).max() for _, done in rows]
        self.assertEqual([point["coupling.stiffness"] for point, _ in rows], ["0.2 N/mm", "0.5 N/mm", "1 N/mm"])
        self.assertTrue(peaks[0] < peaks[1] < peaks[2], peaks)
        patch["coupling.stiffness"] = "0.5 N/mm"
        np.testing.assert_array_equal(patch.render(1.0)["coupling.wrench"].values, rows[1][1]["coupling.wrench"].values)

    def test_errors_have_the_place(self):
        with self.assertRaises(tactus.Error) as caught:
            tactus.parse('[nodes.a]\ntype = "sine"\nrate = "48 kHz"\n[nodes.b]\ntype = "sin"\nrate = "1 kHz"\n')
        self.assertEqual(caught.exception.line, 5)
        with self.assertRaisesRegex(tactus.Error, "stiffness"):
            tactus.load("touch-sphere")["coupling.stifness"] = "1 N/mm"
        with self.assertRaisesRegex(tactus.Error, "no output 'coupling.wrenc'"):
            tactus.load("touch-sphere").start().newest("coupling.wrenc")

    def test_a_loop_of_its_own_moves_a_hand_and_feels_it(self):
        patch = tactus.load("touch-sphere")
        patch.attach_hand("simulated", max_force=8.0, damping=2.0)
        with patch.start(keep=["coupling.wrench"]) as run:
            for tick in range(1000):
                run.move_hand("simulated", (0, 0, 0.005 - 1e-5 * min(tick, 700)))
                run.advance(0.001)
            self.assertGreater(run.force("simulated")[2], 0.5)
            self.assertEqual(len(run.fetch("coupling.wrench")), 1000)
            run["coupling.stiffness"] = "0.5 N/mm"
            before = run.force("simulated")[2]
            run.advance(0.2)
            self.assertLess(run.force("simulated")[2], before)
        self.assertRegex(run.hash, "^[0-9a-f]{16}$")

    def test_other_threads_run_while_one_renders(self):
        patch, ticks = tactus.load("touch-sphere"), []
        thread = threading.Thread(target=lambda: patch.render(5.0, outputs=[], threads=1))
        thread.start()
        while thread.is_alive():
            ticks.append(time.monotonic())
            time.sleep(0.001)
        self.assertGreater(len(ticks), 5)


def vibration(rate, seconds=4.0, seed=1, tone=120.0):
    t = np.arange(int(rate * seconds)) / rate
    return np.sin(2 * np.pi * tone * t) + 0.5 * np.sin(4 * np.pi * tone * t) + \
        0.1 * np.random.default_rng(seed).standard_normal(len(t))


class Analyses(unittest.TestCase):
    def test_a_spectrum_is_the_mean_of_windowed_periodograms(self):
        rate, segment = 2000.0, 512
        x = vibration(rate)
        frequencies, density = tactus.spectrum(x, rate, segment)
        window = 0.5 - 0.5 * np.cos(2 * np.pi * np.arange(segment) / segment)
        starts = range(0, len(x) - segment + 1, segment // 2)
        parts = [np.abs(np.fft.rfft(window * (x[k:k + segment] - x[k:k + segment].mean())))**2 for k in starts]
        expected = np.mean(parts, axis=0) / (rate * np.sum(window**2))
        expected[1:-1] *= 2
        np.testing.assert_allclose(frequencies, np.fft.rfftfreq(segment, 1 / rate))
        np.testing.assert_allclose(density, expected, rtol=1e-9, atol=1e-12)
        # A tone of amplitude 1 has the power 1/2.
        near = (frequencies > 105) & (frequencies < 135)
        self.assertAlmostEqual(density[near].sum() * frequencies[1], 0.5, delta=0.02)

    def test_a_column_of_a_run_can_be_analysed_as_it_is(self):
        force = tactus.load("touch-sphere").render(2.0)["coupling.wrench"]
        frequencies, density = tactus.spectrum(force["fz"], force.rate)
        self.assertEqual(frequencies[-1], 500.0)
        self.assertTrue(np.all(density >= 0.0))

    def test_a_comparison_finds_delay_gain_and_likeness(self):
        rate = 4000.0
        x = np.random.default_rng(3).standard_normal(int(4 * rate))
        same = tactus.compare(x, x, rate)
        self.assertAlmostEqual(same.delay, 0.0, delta=1e-3)
        self.assertAlmostEqual(same.spectral_cosine, 1.0, delta=1e-6)
        self.assertAlmostEqual(same.gain_db, 0.0, delta=1e-6)
        late = tactus.compare(x, np.concatenate([np.zeros(200), 0.5 * x])[:len(x)], rate)
        self.assertAlmostEqual(late.delay, 0.05, delta=1e-3)
        self.assertAlmostEqual(late.gain_db, 20 * np.log10(2), delta=0.2)
        other = tactus.compare(x, vibration(rate, seed=9), rate)
        self.assertTrue(np.isnan(other.delay))
        self.assertLess(other.spectral_cosine, 0.9)

    def test_an_exposure_is_that_of_the_weighted_tone(self):
        rate = 20000.0
        t = np.arange(int(10 * rate)) / rate
        tone = np.sqrt(2) * np.sin(2 * np.pi * 15.915 * t)  # 1 m/s² r.m.s.; Wh there is 0.896 (ISO 5349-1, table A.2: 16 Hz)
        found = tactus.exposure(np.stack([tone, 0 * t, 2 * tone], axis=1), rate, 4 * 3600.0)
        self.assertAlmostEqual(found.weighted[0], 0.896, delta=0.01)
        self.assertEqual(found.weighted[1], 0.0)
        self.assertAlmostEqual(found.total, np.sqrt(5) * found.weighted[0], delta=1e-3)
        self.assertAlmostEqual(found.a8, found.total * np.sqrt(0.5), delta=1e-9)
        self.assertAlmostEqual(found.seconds_to_action, 8 * 3600 * (2.5 / found.total)**2, delta=1.0)

    def test_wrong_records_are_errors_that_say_what(self):
        for samples, words in (("text", "not numbers"), ([], "no samples"), ([[1, 2], [3, 4]], "shape"),
                               ([1.0, np.nan], "sample 1 is not finite"), ([1 + 2j], "not numbers"),
                               (np.array([object()]), "not numbers")):
            with self.assertRaisesRegex(tactus.Error, words):
                tactus.spectrum(samples, 1000.0)
        for rate in (0.0, -1.0, 1e300, float("nan"), float("inf")):
            with self.assertRaisesRegex(tactus.Error, "rate"):
                tactus.spectrum([1.0, 2.0], rate)
        with self.assertRaises(tactus.Error):
            tactus.compare(np.zeros(1000), np.zeros(1000), 1000.0)
        with self.assertRaises(tactus.Error):
            tactus.compare([1.0], [2.0], 1000.0)
        with self.assertRaisesRegex(tactus.Error, "column for each axis"):
            tactus.exposure(np.zeros(10), 1000.0)
        with self.assertRaisesRegex(tactus.Error, "a day"):
            tactus.exposure(np.zeros((10, 3)), 1000.0, 1e9)

    def test_integers_floats_and_strided_columns_give_the_same(self):
        whole = (100 * vibration(1000.0)).astype(np.int16)
        expected = tactus.spectrum(whole.astype(float), 1000.0)[1]
        for samples in (whole, whole.astype(np.float32), np.stack([whole, whole], axis=1)[:, 0], whole.reshape(-1, 1)):
            np.testing.assert_array_equal(tactus.spectrum(samples, 1000.0)[1], expected)


class Plugins(unittest.TestCase):
    def test_nodes_from_outside_run_in_python(self):
        # A process of its own: nodes are loaded once.
        script = """
import numpy, tactus
run = tactus.parse('wires = ["v.signal -> f.in"]\\n[nodes.v]\\ntype = "sine"\\nrate = "48 kHz"\\n'
                   '[nodes.f]\\ntype = "fold"\\nrate = "48 kHz"\\ngain = "3"\\n').render(0.1)
numpy.testing.assert_allclose(run["f.out"].values, numpy.sin(3.0 * run["v.signal"].values), atol=1e-6)
"""
        fold = pathlib.Path(os.environ["TACTUS_TEST_PLUGINS"]) / "fold.so"
        done = subprocess.run([sys.executable, "-c", script], env={**os.environ, "TACTUS_NODES": str(fold)},
                              capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        wrong = subprocess.run([sys.executable, "-c", "import tactus; tactus.load('touch-sphere')"], capture_output=True,
                               env={**os.environ, "TACTUS_NODES": str(fold.with_name("faulty_other_headers.so"))}, text=True)
        self.assertIn("tactus.errors.Error", wrong.stderr)
        self.assertIn("Rebuild", wrong.stderr)


CLIPPED = """
wires = ["s.signal -> clip.in", "hand.twist -> place.twist", "hand.pose -> place.pose"]
[devices.simulated]
driver = "scripted"
targets = "0 s: 0 0 60 mm; 0.1 s: 10 20 50 mm"
[nodes]
s = { type = "sine", rate = "48 kHz" }
clip = { type = "py_clip", rate = "48 kHz", drive = "3" }
hand = { type = "device_input", rate = "1 kHz" }
place = { type = "py_place", rate = "1 kHz" }
"""


def declare_nodes():
    @tactus.node("py_clip", inputs={"in": "signal"}, outputs={"out": tactus.Port("signal", about="clipped")},
                 parameters={"drive": ("1", "0", "10")})
    def clip(block):
        """Bends a signal
        softly."""
        np.tanh(np.float32(block["drive"]) * block["in"], out=block["out"])

    @tactus.node("py_place", inputs={"pose": "pose", "twist": "twist"},
                 outputs={"pose_out": "pose", "speed": tactus.Port("number", "m/s"), "at": tactus.Port("vector", "m"),
                          "moves": "bool"})
    class Place:
        def process(self, block):
            block["pose_out"] = block["pose"]
            block["speed"] = np.linalg.norm(block["twist"][:, :3], axis=1)
            block["at"] = block["pose"][:, :3]
            block["moves"] = block["speed"] > 0


class Nodes(unittest.TestCase):
    def render(self, code, type="py_test", seconds=0.01, **ports):
        tactus.node(type, **(ports or dict(outputs={"out": "signal"})))(code)
        return tactus.parse(f'[nodes.a]\ntype = "{type}"\nrate = "48 kHz"\n').render(seconds)

    def test_every_type_passes_as_an_array_in_si_units(self):
        declare_nodes()
        run = tactus.parse(CLIPPED).render(0.1)
        np.testing.assert_array_equal(run["clip.out"]["value"],
                                      np.tanh(np.float32(3) * run["s.signal"]["value"].astype(np.float32)))
        np.testing.assert_array_equal(run["place.pose_out"].values, run["hand.pose"].values)
        np.testing.assert_array_equal(run["place.at"].values, run["hand.pose"].values[:, :3])
        np.testing.assert_allclose(run["place.speed"]["value"], np.linalg.norm(run["hand.twist"].values[:, :3], axis=1))
        np.testing.assert_array_equal(run["place.moves"]["value"], run["place.speed"]["value"] > 0)
        self.assertGreater(run["place.speed"]["value"].max(), 0.01)

    def test_a_render_on_any_threads_and_any_steps_of_advance_have_the_same_bits(self):
        declare_nodes()

        @tactus.node("py_echo", inputs={"in": "signal"}, outputs={"out": "signal"})
        class Echo:
            def prepare(self, setup):
                self.past = np.zeros(int(0.003 * setup.rate), np.float32)

            def process(self, block):
                for i in range(block.frames):  # a loop is slow and simple: one sample each
                    block["out"][i] = block["in"][i] + np.float32(0.5) * self.past[0]
                    self.past = np.append(self.past[1:], block["out"][i])

        patch = tactus.parse(CLIPPED.replace('hand.twist ->', 's.signal -> echo.in", "hand.twist ->') +
                             'echo = { type = "py_echo", rate = "48 kHz" }\n')
        expected = {patch.render(0.05, threads=threads).hash for threads in (1, 3)}
        for step in (0.05, 0.001, 0.0007, 0.00001 * 7):
            with patch.start() as run:
                while run.time < 0.05 - 1e-9:
                    run.advance(min(step, 0.05 - run.time))
            expected.add(run.hash)
        self.assertEqual(len(expected), 1)

    def test_arrays_lie_in_the_memory_of_the_engine(self):
        seen = []

        def keep(block):
            seen.append((block["out"].__array_interface__["data"][0], block["out"].base is not None, block.frames))
            block["out"][:] = block.t

        run = self.render(keep)
        np.testing.assert_array_equal(run["a.out"]["value"], (np.arange(480) / 48000).astype(np.float32))
        self.assertEqual(len({place for place, _, _ in seen}), 1)  # the engine's, reused
        self.assertTrue(all(is_view for _, is_view, _ in seen))
        self.assertGreater(max(frames for _, _, frames in seen), 1)

    def test_an_array_that_is_kept_outlives_the_run(self):
        kept = []
        self.render(lambda block: kept.append((block, block["out"])))
        for i in range(20):
            self.render(lambda block: None)
        gc.collect()
        for block, array in kept:
            array[:] = 1.0
            with self.assertRaisesRegex(tactus.Error, "the block is over"):
                block["out"]

    def test_an_output_that_is_left_alone_holds_its_value(self):
        def once(block):
            if block.index == 0:
                block["out"][-1] = 4.0

        values = self.render(once)["a.out"]["value"]
        first = int(np.argmax(values))
        np.testing.assert_array_equal(values, np.where(np.arange(480) < first, 0.0, 4.0))

    def test_what_a_callback_does_wrong_is_one_error_with_the_place(self):
        def divide(block):
            return 1 // 0

        def assign(values, port="out"):
            def process(block):
                block[port] = values
            return process

        def write_input(block):
            block["in"][:] = 0.0

        def wrong_slice(block):
            block["out"][:] = np.zeros(7)

        for code, words in ((divide, r"ZeroDivisionError: .*test_tactus.py, line \d+"),
                            (assign(np.zeros(7)), r"'out' has the shape \(\d+,\), given \(7,\)"),
                            (assign(np.zeros((2, 2))), "given \\(2, 2\\)"),
                            (assign(1j), "'out' holds float32, given complex128"), (assign("a"), "given <U1"),
                            (assign(object()), "given object"), (assign(0, "ou"), "no port or parameter 'ou'"),
                            (wrong_slice, "could not broadcast"), (lambda: None, "TypeError")):
            with self.assertRaisesRegex(tactus.Error, "node 'a' of type 'py_test': (?s:.*)" + words) as caught:
                self.render(code)
            self.assertEqual(caught.exception.line, 1)
            self.assertIsNotNone(caught.exception.__cause__)
        tactus.node("py_test", inputs={"in": "signal"}, outputs={"out": "signal"})(write_input)
        with self.assertRaisesRegex(tactus.Error, "read-only"):
            tactus.parse('wires = ["s.signal -> a.in"]\n[nodes]\ns = { type = "sine", rate = "48 kHz" }\n'
                         'a = { type = "py_test", rate = "48 kHz" }\n').render(0.01)

    def test_an_interrupt_within_a_callback_interrupts_the_render(self):
        def interrupt(block):
            raise KeyboardInterrupt

        with self.assertRaises(KeyboardInterrupt):
            self.render(interrupt, seconds=3600)
        self.assertEqual(len(self.render(lambda block: None)["a.out"]), 480)

    def test_a_failure_while_preparing_is_an_error_of_start(self):
        class Node:
            def prepare(self, setup):
                raise ValueError(f"{setup.name} at {setup.rate:g} Hz, {setup.max_frames > 0}, {setup.seed != 0}")

            def process(self, block):
                pass

        with self.assertRaisesRegex(tactus.Error, "ValueError: a at 48000 Hz, True, True"):
            self.render(Node)

    def test_wrong_declarations_are_errors(self):
        for name, arguments, words in (
                ("gain", {}, "Tactus has a type of this name already"), ("a b", {}, "a name has letters"),
                ("py_test", dict(inputs={"in": "event"}), "'event' is not one of"),
                ("py_test", dict(inputs={"in": tactus.Port("signal", "parsec")}), "unit of 'in'"),
                ("py_test", dict(parameters={"gain": ("1", "2", "3")}), "gain"),
                ("py_test", dict(inputs={"x": "signal"}, outputs={"x": "signal"}), "listed twice")):
            with self.assertRaisesRegex(tactus.Error, words):
                tactus.node(name, **arguments)(lambda block: None)
        with self.assertRaisesRegex(tactus.Error, "with 'process'"):
            tactus.node("py_test")(type("Empty", (), {}))

    def test_a_live_run_refuses_a_node_of_python(self):
        declare_nodes()
        with self.assertRaisesRegex(tactus.Error, "node 'clip' of type 'py_clip' .* cannot run live") as caught:
            tactus.parse(CLIPPED).start(0.1, live=True)
        self.assertEqual(caught.exception.line, 8)

    def test_a_callback_that_uses_its_own_run_gets_an_error(self):
        runs = []
        tactus.node("py_test", outputs={"out": "signal"})(lambda block: runs[0].advance(0.001))
        runs.append(tactus.parse('[nodes.a]\ntype = "py_test"\nrate = "48 kHz"\n').start())
        with self.assertRaisesRegex(tactus.Error, "another thread is using this run"):
            runs[0].advance(0.01)

    def test_a_sweep_calls_a_node_from_several_threads(self):
        declare_nodes()
        rows = list(tactus.parse(CLIPPED).sweep({"clip.drive": [1, 2, 3, 4]}, 0.05, jobs=3))
        for point, done in rows:
            np.testing.assert_array_equal(
                done["clip.out"]["value"],
                np.tanh(np.float32(point["clip.drive"]) * done["s.signal"]["value"].astype(np.float32)))

    def test_two_threads_on_one_patch_or_run_give_values_or_one_clear_error(self):
        declare_nodes()
        patch = tactus.parse(CLIPPED)
        run, refused, others = patch.start(), [], []

        def work():
            for _ in range(50):
                for use in (lambda: run.advance(0.0005), lambda: patch.start()):
                    try:
                        use()
                    except tactus.Error as error:
                        (refused if "another thread is using" in str(error) else others).append(str(error))

        threads = [threading.Thread(target=work) for _ in range(3)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(others, [])
        self.assertAlmostEqual(run.time, 0.0005 * round(run.time / 0.0005))

    def test_nothing_is_left_of_runs_that_are_over(self):
        before = None
        for i in range(30):
            self.render(lambda block: None, seconds=0.001)
            gc.collect()
            before = before or len(tactus.node.__globals__["_nodes"])
        self.assertEqual(len(tactus.node.__globals__["_nodes"]), before)

    def test_a_program_may_end_with_a_run_that_is_not_over(self):
        script = """
import tactus
tactus.node("py_end", outputs={"out": "signal"})(lambda block: None)
run = tactus.parse('[nodes.a]\\ntype = "py_end"\\nrate = "48 kHz"\\n').start()
run.advance(0.01)
"""
        done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True)
        self.assertEqual((done.returncode, done.stderr), (0, ""))


def lump(rows=30):
    """A closed mesh without symmetry, about 30 mm across: vertices in m, triangles."""
    v, u = np.meshgrid(np.linspace(0, np.pi, rows + 1), np.arange(2 * rows) * np.pi / rows, indexing="ij")
    x, y, z = np.sin(v) * np.cos(u), np.sin(v) * np.sin(u), np.cos(v)
    r = 1e-3 * (12 + 4 * x + 3 * y * z + 2.5 * x * y + 5 * z * z + 3 * y * x * x)
    i, j = (each.reshape(-1) for each in np.meshgrid(np.arange(rows), np.arange(2 * rows), indexing="ij"))
    a, b = i * 2 * rows + j, i * 2 * rows + (j + 1) % (2 * rows)
    c, d = a + 2 * rows, b + 2 * rows
    return (r[..., None] * np.stack([x, y, z], axis=-1)).reshape(-1, 3), np.concatenate(
        [np.stack([a, c, b], axis=1), np.stack([b, c, d], axis=1)])


class Registrations(unittest.TestCase):
    def test_a_moved_mesh_is_brought_back(self):
        vertices, triangles = lump()
        truth = tactus.Pose(np.array([0.03, -0.02, 0.05]), np.array([0.8, 0.0, 0.36, -0.48]))
        found = tactus.register((vertices, triangles), (truth.apply(vertices), triangles))
        self.assertEqual(found.verdict, "fit")
        self.assertLess(np.abs(found.pose.apply(vertices) - truth.apply(vertices)).max(), 20e-6)
        np.testing.assert_allclose(found.pose.matrix @ [0.01, 0.02, 0.03, 1], [*truth.apply([0.01, 0.02, 0.03]), 1],
                                   atol=2e-5)
        self.assertLess(found.p90, 10e-6)
        self.assertEqual(found.covered, 1.0)
        self.assertGreater(found.rival_rms, 10 * found.rms)

    def test_meshes_of_any_types_and_layouts_give_the_same_as_the_command(self):
        vertices, triangles = lump(12)
        moved = tactus.Pose(np.array([0.01, 0.0, 0.0]), np.array([1.0, 0.0, 0.0, 0.0])).apply(vertices)
        expected = tactus.register((vertices, triangles), (moved, triangles))
        again = tactus.register((np.asfortranarray(vertices), triangles.astype(np.uint16)),
                                (moved.tolist(), triangles.tolist()))
        np.testing.assert_array_equal(again.pose.position, expected.pose.position)
        with tempfile.TemporaryDirectory() as folder:
            for name, corners in (("moving", vertices), ("fixed", moved)):
                lines = [f"v {x:.17g} {y:.17g} {z:.17g}" for x, y, z in 1e3 * corners]
                lines += [f"f {a + 1} {b + 1} {c + 1}" for a, b, c in triangles]
                pathlib.Path(f"{folder}/{name}.obj").write_text("\n".join(lines) + "\n")
            done = subprocess.run([COMMAND, "register", f"{folder}/moving.obj", f"{folder}/fixed.obj", "--json"],
                                  capture_output=True, text=True)
            self.assertEqual(done.returncode, 0, done.stderr)
            told = json.loads(done.stdout)
        self.assertEqual(told["verdict"], expected.verdict)
        np.testing.assert_allclose(told["pose"]["position_mm"], 1e3 * expected.pose.position, atol=0.02)

    def test_wrong_meshes_are_errors_that_say_which(self):
        good = lump(8)
        vertices, triangles = good
        for mesh, words in (((vertices * 1e3, triangles), "vertices are in m"), (vertices, "no pair of arrays"),
                            (None, "no pair"),
                            ((vertices[:, :2], triangles), r"shape \(\d+, 2\)"),
                            ((vertices, triangles.astype(float)), "float64, not integers"),
                            ((vertices, triangles - 1), "from -1"), ((vertices, triangles + 2**33), "vertices from"),
                            ((vertices.astype(complex), triangles), "not numbers"),
                            ((vertices, triangles[:0]), "no triangles"),
                            ((np.full_like(vertices, np.nan), triangles), "not finite")):
            with self.assertRaisesRegex(tactus.Error, f"fixed mesh.*{words}|{words}.*fixed mesh"):
                tactus.register(good, mesh)


def slab():
    """A closed box, m, whose top is at z = 0: vertices, triangles."""
    corners = [(x, y, z) for z in (-0.01, 0.0) for y in (-0.02, 0.02) for x in (-0.02, 0.02)]
    return np.array(corners), np.array([(0, 2, 1), (1, 2, 3), (4, 5, 6), (5, 7, 6), (0, 1, 4), (1, 5, 4),
                                        (2, 6, 3), (3, 6, 7), (0, 4, 2), (2, 4, 6), (1, 3, 5), (3, 7, 5)])


class Contacts(unittest.TestCase):
    def test_a_cube_on_a_slab_has_the_force_of_its_face_and_torques_about_its_pose(self):
        vertices, triangles = slab()
        # 8 × 8 × 10 mm, bottom at z = 0.
        cube = (vertices + [0, 0, 0.005]) * [0.2, 0.2, 1] + [0.004, 0, 0.005], triangles
        contact = tactus.Contact(cube, slab(), stiffness=1e9, voxel=0.25e-3)
        depths = np.linspace(0.1e-3, 0.4e-3, 4)
        poses = np.array([[0, 0, -depth, 1, 0, 0, 0] for depth in depths])
        found = contact(poses)
        self.assertEqual((found.wrench.shape, found.stiffness.shape, found.energy.shape), ((4, 6), (4, 6, 6), (4,)))
        force = 1e9 * (0.008**2 * depths + 4 * 0.008 * depths**2 / 2)  # of its bottom and its sides
        np.testing.assert_allclose(found.wrench[:, 2], force, rtol=0.05)
        np.testing.assert_allclose(found.wrench[:, 4], -0.004 * found.wrench[:, 2], rtol=0.03)
        np.testing.assert_allclose(found.penetration, depths, rtol=0.02)
        self.assertTrue(np.all(found.points > 100))
        one = contact(tactus.Pose(poses[1, :3], poses[1, 3:]))
        self.assertEqual(one.stiffness.shape, (6, 6))
        np.testing.assert_array_equal(one.wrench, found.wrench[1])
        np.testing.assert_array_equal(contact(poses[1].tolist()).wrench, one.wrench)
        np.testing.assert_allclose(one.stiffness, one.stiffness.T)
        slope = (found.wrench[0, 2] - found.wrench[2, 2]) / (depths[0] - depths[2])
        self.assertAlmostEqual(one.stiffness[2, 2] / slope, 1.0, delta=0.05)
        self.assertEqual(contact([0, 0, 0.001, 1, 0, 0, 0]).points, 0)
        self.assertEqual(contact(np.zeros((0, 7))).wrench.shape, (0, 6))

    def test_wrong_contacts_are_errors_that_say_what(self):
        vertices, triangles = slab()
        for fixed, arguments, words in (((vertices, triangles[1:]), {}, "not closed"),
                                        ((vertices, triangles[:, ::-1]), {}, "inside out"),
                                        (slab(), dict(voxel=1e-5), "wider voxel"),
                                        (slab(), dict(spacing=-1), "above 0"),
                                        (slab(), dict(stiffness=float("nan")), "above 0"),
                                        (vertices, {}, "no pair of arrays")):
            with self.assertRaisesRegex(tactus.Error, words):
                tactus.Contact(slab(), fixed, **arguments)
        contact = tactus.Contact(slab(), slab(), voxel=1e-3, spacing=1e-3)
        for poses, words in ((np.zeros((2, 6)), r"given float64 \(2, 6\)"), ("pose", "given <U4"),
                             (np.zeros(7), "pose 0 is not valid"), (None, "given object"),
                             ([[0, 0, 0, 1, 0, 0, 0], [0, 0, np.nan, 1, 0, 0, 0]], "pose 1 is not valid")):
            with self.assertRaisesRegex(tactus.Error, words):
                contact(poses)

    def test_two_threads_on_one_contact_give_sums_or_one_clear_error(self):
        contact = tactus.Contact(slab(), slab(), voxel=1e-3, spacing=1e-3)
        pose, others = np.tile([0, 0, 0.009, 1, 0, 0, 0], (200, 1)), []
        expected = contact(pose).wrench

        def work():
            for _ in range(30):
                try:
                    np.testing.assert_array_equal(contact(pose).wrench, expected)
                except tactus.Error as error:
                    if "another thread is using this contact" not in str(error):
                        others.append(str(error))

        threads = [threading.Thread(target=work) for _ in range(3)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(others, [])


class LiveRuns(unittest.TestCase):
    def test_without_a_run_it_says_so(self):
        with tempfile.TemporaryDirectory() as folder:
            os.environ["XDG_RUNTIME_DIR"] = folder
            with self.assertRaisesRegex(tactus.Error, "no run"):
                tactus.Live()

    def test_a_parameter_is_set_and_a_refusal_is_an_error(self):
        with tempfile.TemporaryDirectory() as folder:
            os.environ["XDG_RUNTIME_DIR"] = folder
            os.mkdir(f"{folder}/tactus")
            server = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
            server.bind(f"{folder}/tactus/1.socket")
            server.listen(1)

            def answer():
                peer, _ = server.accept()
                lines = peer.makefile("rw")
                for reply in ("a.b=1 from 0.5 s", "error no node 'c'"):
                    self.assertTrue(lines.readline().startswith("set "))
                    lines.write(reply + "\n")
                    lines.flush()
                peer.close()

            thread = threading.Thread(target=answer)
            thread.start()
            with tactus.Live() as live:
                self.assertEqual(live.set("a.b", 1), "a.b=1 from 0.5 s")
                with self.assertRaisesRegex(tactus.Error, "no node 'c'"):
                    live["c.d"] = "2 N"
            thread.join()
            server.close()


if __name__ == "__main__":
    unittest.main(verbosity=2)
