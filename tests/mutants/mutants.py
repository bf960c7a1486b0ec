#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Mutation test of code that limits forces, carves and judges exposures.

    mutants.py write SOURCE_FOLDER OUTPUT_FOLDER   copies of the sources in which TACTUS_MUTANT=N switches on fault N
    mutants.py run PROGRAM                         runs the tests once for each fault; fails if they pass with one
"""
import concurrent.futures
import os
import pathlib
import subprocess
import sys
import tomllib

HERE = pathlib.Path(__file__).parent


def mutants():
    """(number, file entry, original, mutated, reason of an equivalent one) of every mutant."""
    number = 0
    with open(HERE / "mutants.toml", "rb") as stream:
        files = tomllib.load(stream)["file"]
    for entry in files:
        for original, mutated, *reason in entry["mutants"]:
            number += 1
            yield number, entry, original, mutated, reason[0] if reason else None


def parts_of(original):
    """The text before, within and after « »; without them, all of it is within."""
    if "«" not in original:
        return "", original, ""
    before, rest = original.split("«")
    within, after = rest.split("»")
    return before, within, after


def write(source_folder, output_folder):
    texts = {}
    for number, entry, original, mutated, _ in mutants():
        source = entry["source"]
        if source not in texts:
            texts[source] = pathlib.Path(source_folder, source).read_text(encoding="utf-8")
        plain = "".join(parts_of(original))
        if texts[source].count(plain) != 1:
            sys.exit(f"mutants.toml: '{plain}' occurs {texts[source].count(plain)} times in {source}, not once; "
                     "adapt the mutant to the source")
        before, first, after = parts_of(original)
        choice = f"{before}(::tactus::test::is_mutant({number}) ? ({mutated}) : ({first})){after}"
        texts[source] = texts[source].replace(plain, choice)
    for source, text in texts.items():
        file = pathlib.Path(output_folder, source)
        file.parent.mkdir(parents=True, exist_ok=True)
        text = '#include "tests/mutants/mutant.hpp"\n' + text
        if not file.exists() or file.read_text(encoding="utf-8") != text:
            file.write_text(text, encoding="utf-8")


def passes(program, number, tests):
    spec = ",".join(f"[#{test}]~[slow]~[long]" for test in tests)
    done = subprocess.run([program, "-#", "--abort", spec], env={**os.environ, "TACTUS_MUTANT": str(number)},
                          stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, timeout=120, check=False)
    return done.returncode == 0


def killed(program, mutant):
    number, entry, _, _, reason = mutant
    try:
        return reason is not None or not passes(program, number, entry["tests"])
    except subprocess.TimeoutExpired:
        return True


def run(program):
    everything = sorted({test for _, entry, *_ in mutants() for test in entry["tests"]})
    if not passes(program, 0, everything):
        sys.exit("the tests fail without a mutant")
    alive = []
    known = list(mutants())
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for mutant, is_killed in zip(known, pool.map(lambda m: killed(program, m), known)):
            if not is_killed:
                alive.append(mutant)
    for number, entry, original, mutated, _ in alive:
        print(f"mutant {number} of {entry['source']} passes the tests: '{mutated}' instead of '{original}'")
    print(f"{len(known) - len(alive)} of {len(known)} mutants killed or listed as equivalent")
    return 1 if alive else 0


if __name__ == "__main__":
    if len(sys.argv) == 4 and sys.argv[1] == "write":
        write(sys.argv[2], sys.argv[3])
    elif len(sys.argv) == 3 and sys.argv[1] == "run":
        sys.exit(run(sys.argv[2]))
    else:
        sys.exit(__doc__)
