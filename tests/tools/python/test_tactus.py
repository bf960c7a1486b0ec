# SPDX-License-Identifier: Apache-2.0
"""tactus in Python, each test named as a claim. Run by ctest with the library and the command of the build."""

import gc
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
