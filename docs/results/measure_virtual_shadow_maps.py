#!/usr/bin/env python3
"""Measures virtual shadow maps with the program and prints the tables of virtual-shadow-maps.md.

usage: measure_virtual_shadow_maps.py PROGRAM SCENES_DIR [counts|texels|errors] …
Counts do not depend on how busy the machine is; times do, so only ratios within one run are meant."""
import json
import subprocess
import sys
import tempfile
from pathlib import Path

program, scenes_dir = sys.argv[1], Path(sys.argv[2])
wanted = sys.argv[3:] or ["counts", "texels", "errors"]

CULLING = ["naive", "CFM", "PMC", "PMC-EB", "PMCD", "PMCD-EB", "default"]
TEXELS = ["PMCD", "PMCD-EB-1SM", "PMCD-EB-2SM", "PMCD-EB-4SM", "PMCD-EB-8SM", "PMCD-EB-16SM", "u2", "u4", "default", "default-u2"]
SCENES = {
    "hall, 65 lights": ["hall/hall_65.glb"],
    "sponza": ["sponza/sponza.gltf", "--lights", "sponza/lights_65.json"],
    "houses": ["builtin:houses"],
    "nexuiz_accident": ["nexuiz_accident/accident.gltf"],
    "stk_black_forest": ["stk_black_forest/black_forest.gltf"],
    "zad_necropolis": ["zad_necropolis/necropolis.gltf", "--lights", "zad_necropolis/lights_356.json"],
}


def arguments_of(scene):
    return [str(scenes_dir / word) if "/" in word else word for word in SCENES[scene]]


def run(command, scene, more):
    with tempfile.TemporaryDirectory() as folder:
        stats = Path(folder) / "stats.json"
        outputs = ["-o", str(Path(folder) / "image.png"), "--stats", str(stats)] if command == "render" else []
        done = subprocess.run([program, command, *arguments_of(scene), *more, *outputs], check=True, capture_output=True, text=True)
        return json.loads(stats.read_text() if command == "render" else done.stdout)


def row(cells):
    print("| " + " | ".join(str(cell) for cell in cells) + " |", flush=True)


def table(head):
    row(head)
    row(["---"] + ["---:"] * (len(head) - 1))


def millions(count):
    return f"{count / 1e6:.2f}"


def counts():
    print("Triangles drawn, million (triangle, view) pairs, 1280×720, budget 2048 MiB\n")
    table(["Scene", *CULLING, "naive / PMCD-EB", "naive / default"])
    for scene in SCENES:
        drawn = {preset: run("render", scene, ["--preset", preset, "--budget", "2048"])["triangles_drawn"] for preset in CULLING}
        row([scene, *(millions(drawn[preset]) for preset in CULLING), f"{drawn['naive'] / drawn['PMCD-EB']:.1f}", f"{drawn['naive'] / drawn['default']:.1f}"])


def texels():
    print("\nTexels allocated, million, 1280×720, budget 2048 MiB; PMCD has implicit bounds\n")
    table(["Scene", "lighting computations", *TEXELS])
    for scene in SCENES:
        stats = {preset: run("render", scene, ["--preset", preset, "--budget", "2048"]) for preset in TEXELS}
        row([scene, millions(stats["default"]["lighting_computations"]), *(millions(stats[preset]["texels_allocated"]) for preset in TEXELS)])


def errors():
    print("\nWrong visibility, % of evaluated pixel×light pairs, 640×360, budget 256 MiB: outside the 3-pixel band / the texel band\n")
    presets = ["default", "PMCD-EB", "u4", "fixed-cubes"]
    table(["Scene", *presets, "lights coarser (default)", "unbacked taps"])
    for scene in SCENES:
        found = {preset: run("compare", scene, ["--preset", preset, "--size", "640x360"]) for preset in presets}
        cells = [f"{100 * d['wrong_outside_band']:.3f} / {100 * d['wrong_outside_texel_band']:.3f}" for d in found.values()]
        row([scene, *cells, found["default"]["lights_degraded"], sum(d["unbacked_taps"] for d in found.values())])


for name in wanted:
    {"counts": counts, "texels": texels, "errors": errors}[name]()
