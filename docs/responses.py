#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Draws what nodes do, by the built command: pictures/responses/TYPE.svg. docs/responses.py [COMMAND]

Filters: magnitude over frequency. Waves, envelopes, lags: value over time. Guides: force over distance. Needs no other
package. Each curve comes from a rendered patch, not from a formula."""
import cmath
import math
import os
import struct
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
TACTUS = os.path.abspath(sys.argv[1] if len(sys.argv) > 1 else os.path.join(HERE, "../build/release/tactus"))
FOLDER = os.path.join(HERE, "pictures/responses")
COLOURS = ["#2563eb", "#dc2626", "#059669", "#d97706", "#7c3aed", "#0891b2", "#be185d", "#4b5563"]


def read_wav(path):
    """Samples of a mono file of 32-bit floats."""
    with open(path, "rb") as file:
        data = file.read()
    at = 12
    while data[at:at + 4] != b"data":
        at += 8 + struct.unpack("<I", data[at + 4:at + 8])[0]
    size = struct.unpack("<I", data[at + 4:at + 8])[0]
    return struct.unpack(f"<{size // 4}f", data[at + 8:at + 8 + size])


def read_csv(path):
    with open(path, encoding="utf-8") as file:
        next(file)
        return [[float(cell) for cell in line.split(",")] for line in file]


def render(wires, nodes, seconds, head=""):
    """The files of a run, by name."""
    text = "wires = [" + ", ".join(f'"{wire}"' for wire in wires) + "]\n" + head + "[nodes]\n"
    text += "".join(f"{name} = {{ {body} }}\n" for name, body in nodes.items())
    with tempfile.TemporaryDirectory() as folder:
        with open(os.path.join(folder, "p.toml"), "w", encoding="utf-8") as file:
            file.write(text)
        out = os.path.join(folder, "out")
        done = subprocess.run([TACTUS, "render", os.path.join(folder, "p.toml"), "--seconds", str(seconds), "--out", out],
                              capture_output=True, text=True, check=False)
        if done.returncode != 0:
            sys.exit(f"{text}\n{done.stderr}")
        files = {}
        for name in os.listdir(out):
            path = os.path.join(out, name)
            if name.endswith(".wav"):
                files[name[:-4]] = read_wav(path)
            elif name.endswith(".csv"):
                files[name[:-4]] = read_csv(path)
        return files


def ticks(low, high, logarithmic):
    if logarithmic:
        return [10.0 ** e for e in range(math.ceil(math.log10(low) - 1e-9), math.floor(math.log10(high) + 1e-9) + 1)]
    step = 10.0 ** math.floor(math.log10((high - low) / 4.0))
    for factor in (1, 2, 5, 10):
        if (high - low) / (step * factor) <= 6:
            step *= factor
            break
    return [k * step for k in range(math.ceil(low / step - 1e-9), math.floor(high / step + 1e-9) + 1)]


def label(value):
    return f"{value / 1000:g}k" if abs(value) >= 1000 else f"{value:g}" if abs(value) > 1e-12 else "0"


def draw(name, x_label, y_label, curves, log_x=False, y_range=None):
    """curves: {name: [(x, y), …]}."""
    width, height, left, right, top, bottom = 460, 230, 52, 12, 12, 40
    xs = [p[0] for c in curves.values() for p in c]
    ys = [p[1] for c in curves.values() for p in c]
    x0, x1 = min(xs), max(xs)
    y0, y1 = y_range or (min(ys), max(ys))
    if y_range is None:
        y0, y1 = y0 - 0.06 * (y1 - y0 or 1.0), y1 + 0.06 * (y1 - y0 or 1.0)
    scale = math.log10 if log_x else (lambda v: v)

    def px(x):
        return left + (scale(x) - scale(x0)) / (scale(x1) - scale(x0)) * (width - left - right)

    def py(y):
        return height - bottom - (min(max(y, y0), y1) - y0) / (y1 - y0) * (height - top - bottom)

    svg = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" width="{width}" height="{height}" '
           'font-family="sans-serif" font-size="11">', '<rect width="100%" height="100%" fill="#ffffff"/>']
    for x in ticks(x0, x1, log_x):
        svg.append(f'<path d="M{px(x):.1f} {top}V{height - bottom}" stroke="#e2e8f0"/>'
                   f'<text x="{px(x):.1f}" y="{height - bottom + 14}" text-anchor="middle">{label(x)}</text>')
    for y in ticks(y0, y1, False):
        svg.append(f'<path d="M{left} {py(y):.1f}H{width - right}" stroke="#e2e8f0"/>'
                   f'<text x="{left - 5}" y="{py(y) + 4:.1f}" text-anchor="end">{label(y)}</text>')
    svg.append(f'<text x="{(left + width - right) / 2}" y="{height - 8}" text-anchor="middle">{x_label}</text>')
    svg.append(f'<text transform="translate(13 {(top + height - bottom) / 2}) rotate(-90)" text-anchor="middle">{y_label}'
               '</text>')
    for k, (curve, points) in enumerate(curves.items()):
        colour = COLOURS[k % len(COLOURS)]
        path = " ".join(f"{px(x):.1f},{py(y):.1f}" for x, y in points)
        svg.append(f'<polyline points="{path}" fill="none" stroke="{colour}" stroke-width="1.5"/>')
        if len(curves) > 1:
            svg.append(f'<text x="{width - right - 6}" y="{top + 14 + 13 * k}" text-anchor="end" fill="{colour}" '
                       'stroke="#ffffff" stroke-width="3" paint-order="stroke">'
                       f'{curve}</text>')
    with open(os.path.join(FOLDER, name + ".svg"), "w", encoding="utf-8") as file:
        file.write("\n".join(svg) + "\n</svg>\n")
    print(name + ".svg")


def thinned(points, count=300):
    step = max(1, len(points) // count)
    return points[::step]


# Filters.
def magnitudes(node, outputs=("out",), points=120):
    """dB over Hz of what a node makes of one sample of 1."""
    nodes = {"once": 'type = "clock", rate = "48 kHz", period = "1 s"', "one": 'type = "to_number", rate = "48 kHz"',
             "impulse": 'type = "to_signal", rate = "48 kHz"', "node": node}
    wires = ["once.out -> one.in", "one.out -> impulse.in", "impulse.out -> node.in"]
    for output in outputs:
        nodes["r_" + output] = f'type = "record", rate = "48 kHz", file = "{output}.wav"'
        wires.append(f"node.{output} -> r_{output}.in")
    files = render(wires, nodes, 0.2)
    curves = {}
    for output in outputs:
        samples = [(k, v) for k, v in enumerate(files[output]) if abs(v) > 1e-7]
        curve = []
        for n in range(points + 1):
            frequency = 20.0 * 1000.0 ** (n / points)
            turn = -2j * math.pi * frequency / 48000.0
            gain = abs(sum(v * cmath.exp(turn * k) for k, v in samples))
            curve.append((frequency, 20.0 * math.log10(max(gain, 1e-5))))
        curves[output] = curve
    return curves


def draw_filters():
    kinds = ["lowpass", "highpass", "bandpass", "notch", "peak", "low_shelf", "high_shelf", "allpass"]
    curves = {}
    for kind in kinds:
        curves[kind] = magnitudes(f'type = "filter", rate = "48 kHz", kind = "{kind}", frequency = "1 kHz", q = "1.5", '
                                  'boost = "4"')["out"]
    draw("filter", "Hz; 1 kHz, q 1.5, boost 4", "dB", curves, True, (-40.0, 15.0))
    draw("one_pole", "Hz; 500 Hz", "dB",
         {kind: magnitudes(f'type = "one_pole", rate = "48 kHz", kind = "{kind}", frequency = "500 Hz"')["out"]
          for kind in ("lowpass", "highpass")}, True, (-40.0, 5.0))
    draw("state_variable", "Hz; 1 kHz, q 3", "dB",
         magnitudes('type = "state_variable", rate = "48 kHz", q = "3"', ("low", "band", "high", "notch")), True,
         (-40.0, 15.0))
    draw("comb", "Hz; 1 ms", "dB",
         {text: magnitudes(f'type = "comb", rate = "48 kHz", time = "1 ms", {settings}', points=480)["out"]
          for text, settings in (("back 0.7", 'back = "0.7"'), ("forward 0.7", 'forward = "0.7", back = "0"'))}, True,
         (-15.0, 15.0))


# Values over time.
def over_time(nodes, wires, outputs, seconds, rate="1 kHz"):
    nodes = dict(nodes)
    wires = list(wires)
    for name, port in outputs.items():
        extension = "wav" if rate == "48 kHz" else "csv"
        nodes["r_" + name] = f'type = "record", rate = "{rate}", file = "{name}.{extension}"'
        wires.append(f"{port} -> r_{name}.in")
    files = render(wires, nodes, seconds)
    curves = {}
    for name in outputs:
        if rate == "48 kHz":
            curves[name] = [(1e3 * k / 48000.0, v) for k, v in enumerate(files[name])]
        else:
            curves[name] = [(row[0], row[1]) for row in files[name]]
    return curves


def draw_times():
    gate = {"square": 'type = "slow_oscillator", rate = "1 kHz", shape = "square", frequency = "2 Hz"',
            "gate": 'type = "compare", rate = "1 kHz"'}
    wires = ["square.out -> gate.in"]
    draw("adsr", "s; the gate is open for the first 0.25 s", "level",
         over_time({**gate, "n": 'type = "adsr", rate = "1 kHz", attack = "40 ms", decay = "100 ms", sustain = "0.6", '
                                 'release = "150 ms"'}, wires + ["gate.out -> n.gate"], {"level": "n.level"}, 0.5))
    draw("ramp", "s; triggered at once", "value",
         {shape: over_time({**gate, "n": f'type = "ramp", rate = "1 kHz", time = "300 ms", shape = "{shape}"'},
                           wires + ["gate.out -> n.trigger"], {"out": "n.out"}, 0.45)["out"]
          for shape in ("linear", "smooth")})
    step = {"square": 'type = "slow_oscillator", rate = "1 kHz", shape = "square", frequency = "2 Hz"'}
    for name, settings, said in (("slew", 'rise = "10 1/s", fall = "20 1/s"', "s; input ±1, rise 10/s, fall 20/s"),
                                 ("smooth", 'time = "40 ms"', "s; input ±1, 40 ms"),
                                 ("integrate", 'leak = "0.2 s"', "s; input ±1, leak 0.2 s"),
                                 ("delay", 'time = "100 ms"', "s; input ±1, 100 ms")):
        curves = over_time({**step, "n": f'type = "{name}", rate = "1 kHz", {settings}'}, ["square.out -> n.in"],
                           {"in": "square.out", "out": "n.out"}, 1.0)
        draw(name, said, "value", {key: thinned(points) for key, points in curves.items()})
    draw("slow_oscillator", "s; 1 Hz", "value",
         {shape: thinned(over_time({"n": f'type = "slow_oscillator", rate = "1 kHz", shape = "{shape}"'}, [],
                                   {"out": "n.out"}, 1.5)["out"], 200)
          for shape in ("sine", "triangle", "square", "ramp")})
    draw("oscillator", "ms; 440 Hz, width 25 %", "value",
         {shape: over_time({"n": f'type = "oscillator", rate = "48 kHz", frequency = "440 Hz", shape = "{shape}", '
                                 'width = "25 %"'}, [], {"out": "n.signal"}, 0.005, "48 kHz")["out"]
          for shape in ("sawtooth", "pulse", "triangle", "sine")})
    draw("sine", "ms; 440 Hz", "value",
         over_time({"n": 'type = "sine", rate = "48 kHz", frequency = "440 Hz"'}, [], {"out": "n.signal"}, 0.005, "48 kHz"))
    draw("noise", "ms; level 0.1", "value",
         {colour: over_time({"n": f'type = "noise", rate = "48 kHz", colour = "{colour}"'}, [], {"out": "n.signal"}, 0.01,
                            "48 kHz")["out"] for colour in ("white", "pink")})
    draw("impact", "ms; 150 Hz, 12 ms, at 1 m/s", "m/s²",
         over_time({"once": 'type = "clock", rate = "1 kHz", period = "1 s"', "n": 'type = "impact", rate = "48 kHz"'},
                   ["once.out -> n.hit"], {"out": "n.out"}, 0.06, "48 kHz"))
    swell = {"swell": 'type = "slow_oscillator", rate = "1 kHz", frequency = "5 Hz", shape = "square", amplitude = "0.4", '
                      'offset = "0.5"',
             "tone": 'type = "sine", rate = "48 kHz", frequency = "200 Hz"', "loud": 'type = "gain", rate = "48 kHz"'}
    wires = ["swell.out -> loud.factor", "tone.signal -> loud.in", "loud.out -> n.in"]
    for name, settings in (("compressor", 'threshold = "0.1"'), ("envelope", "")):
        comma = ", " if settings else ""
        curves = over_time({**swell, "n": f'type = "{name}", rate = "48 kHz"{comma}{settings}'}, wires,
                           {"in": "loud.out", "out": "n.out"}, 0.2, "48 kHz")
        draw(name, "ms; a tone of 0.9, then 0.1", "value", {key: thinned(c, 800) for key, c in curves.items()})


# Guides.
def over_way(node, targets, force, x_of):
    head = f'[devices.simulated]\ndriver = "scripted"\ntargets = "{targets}"\n'
    nodes = {"hand": 'type = "device_input", rate = "1 kHz"', "node": node,
             "f": 'type = "record", rate = "1 kHz", file = "force.csv"',
             "p": 'type = "record", rate = "1 kHz", file = "pose.csv"'}
    files = render(["hand.pose -> node.pose", "node.wrench -> f.in", "hand.pose -> p.in"], nodes, 2.0, head)
    points = [(x_of(pose), row[1 + force]) for pose, row in zip(files["pose"], files["force"])]
    return thinned(points, 400)


def draw_guides():
    def x_mm(pose):
        return 1e3 * pose[1]

    def z_mm(pose):
        return 1e3 * pose[3]

    across = "0 s: -20 0 0 mm; 2 s: 20 0 0 mm"
    down = "0 s: 0 0 12 mm; 2 s: 0 0 -12 mm"

    def curve(settings, targets=across, force=0, x_of=x_mm):
        return over_way(settings + ', rate = "1 kHz"', targets, force, x_of)

    draw("point_guide", "mm along x", "N along x",
         {"everywhere": curve('type = "point_guide"'), "reach 12 mm": curve('type = "point_guide", reach = "12 mm"')})
    draw("line_guide", "mm across the line", "N across",
         {"everywhere": curve('type = "line_guide"'),
          "reach 8 mm": curve('type = "line_guide", reach = "8 mm"')})
    draw("plane_guide", "mm above the plane", "N upwards",
         {"wall": curve('type = "plane_guide"', down, 2, z_mm),
          "both": curve('type = "plane_guide", kind = "both"', down, 2, z_mm)})
    draw("box_guide", "mm along x; a box of 20 mm", "N along x",
         {"inside": curve('type = "box_guide", size = "20 mm, 20 mm, 20 mm"'),
          "outside": curve('type = "box_guide", size = "20 mm, 60 mm, 60 mm", keep = "outside"')})
    draw("path_guide", "mm across a straight path", "N across",
         {"path": curve('type = "path_guide", points = "0 -20 0, 0 20 0 mm"')})
    draw("detents", "mm along the axis; 6 mm", "N", {"detents": curve('type = "detents"')})
    draw("dial", "degrees; 12 notches", "N m",
         {"dial": over_way('type = "dial", rate = "1 kHz"', "0 s: 0 0 0 mm, 0 0 -60 deg; 2 s: 0 0 0 mm, 0 0 60 deg", 5,
                           lambda pose: math.degrees(2.0 * math.atan2(pose[7], pose[4])))})
    head = f'[devices.simulated]\ndriver = "scripted"\ntargets = "{across}"\n'
    files = render(["hand.twist -> node.twist", "node.wrench -> f.in", "hand.twist -> v.in"],
                   {"hand": 'type = "device_input", rate = "1 kHz"',
                    "node": 'type = "viscosity", rate = "1 kHz", damping = "50 N s/m", max_force = "1 N"',
                    "f": 'type = "record", rate = "1 kHz", file = "force.csv"',
                    "v": 'type = "record", rate = "1 kHz", file = "twist.csv"'}, 1.0, head)
    draw("viscosity", "mm/s; 50 N s/m, at most 1 N", "N",
         {"drag": thinned([(1e3 * v[1], f[1]) for v, f in zip(files["twist"], files["force"])])})


os.makedirs(FOLDER, exist_ok=True)
draw_filters()
draw_times()
draw_guides()
