#!/usr/bin/env python3
"""Measures virtual shadow maps with the program and prints the tables of virtual-shadow-maps.md.

usage: measure_virtual_shadow_maps.py PROGRAM SCENES_DIR [--keep FOLDER] [TABLE …]
TABLE is one of the functions below; without one, all are printed. FOLDER keeps the statistics of every run of the program and is read
first, so that a measurement goes on where it was stopped. Counts do not depend on how busy the machine is; times do, so those of one
table come from interleaved runs, the quickest of them each, and are meant as ratios."""
import argparse
import json
import subprocess
import tempfile
from pathlib import Path

CULLING = ["naive", "CFM", "PMC", "PMC-EB", "PMCD", "PMCD-EB", "default"]
MAPS = ["PMCD-EB-1SM", "PMCD-EB-2SM", "PMCD-EB", "PMCD-EB-8SM", "PMCD-EB-16SM", "u2", "u4", "default", "default-u2"]
LARGE = {
    "hall, 65 lights": ["hall/hall_65.glb"],
    "sponza": ["sponza/sponza.gltf", "--lights", "sponza/lights_65.json"],
    "houses": ["builtin:houses"],
    "nexuiz_accident": ["nexuiz_accident/accident.gltf"],
    "stk_black_forest": ["stk_black_forest/black_forest.gltf"],
    "zad_necropolis": ["zad_necropolis/necropolis.gltf", "--lights", "zad_necropolis/lights_356.json"],
}
ALL = LARGE | {
    "nexuiz_dieselpower": ["nexuiz_dieselpower/dieselpower.gltf"],
    "openarena_oacmpctf3": ["openarena_oacmpctf3/oacmpctf3.gltf"],
    "hall, 8 lights": ["hall/hall_8.glb"],
    "hall, 256 lights": ["hall/hall_256.glb"],
    "Lights": ["lights_and_masks/Lights.glb"],
    "Cubes": ["lights_and_masks/Cubes.glb"],
    "house, 8 random lights": ["lights_and_masks/house.glb", "--random-lights", "8"],
    "multiple_animated_lights at 1.5 s": ["lights_and_masks/multiple_animated_lights.gltf", "--time", "1.5"],
    "test_lights": ["lights_and_masks/test_lights.gltf"],
    "Fox at 0.4 s, 6 random lights": ["animated/Fox.glb", "--random-lights", "6", "--time", "0.4"],
    "Stag at 1.3 s, 6 random lights": ["animated/Stag.gltf", "--random-lights", "6", "--time", "1.3"],
    "CesiumMan at 0.7 s, 6 random lights": ["animated/CesiumMan.glb", "--random-lights", "6", "--time", "0.7"],
}
SIZE = ["--size", "1280x720", "--budget", "2048"]
SMALL = ["--size", "640x360"]
HOST = {"deform", "gbuffer", "upload", "shade", "blend", "exposure", "tone_map"}  # the sample renderer's passes


class Program:
    """Runs the program and remembers what it said."""

    def __init__(self, path, scenes_dir, keep):
        self.path, self.scenes_dir, self.keep = path, Path(scenes_dir), keep

    def run(self, command, scene, more, take=0):
        """The statistics of one run; runs that differ in take alone are repetitions."""
        arguments = [str(self.scenes_dir / word) if "/" in word else word for word in ALL.get(scene, [scene])]
        kept = Path(self.keep) / ("_".join([command, scene, *more, str(take)]).replace("/", "-").replace(" ", "-") + ".json") if self.keep else None
        if kept and kept.exists():
            return json.loads(kept.read_text())
        with tempfile.TemporaryDirectory() as folder:
            stats = Path(folder) / "stats.json"
            outputs = ["-o", str(Path(folder) / "image.png"), "--stats", str(stats)] if command == "render" else []
            done = subprocess.run([self.path, command, *arguments, *more, *outputs], check=True, capture_output=True, text=True)
            text = stats.read_text() if command == "render" else done.stdout
        if kept:
            kept.parent.mkdir(parents=True, exist_ok=True)
            kept.write_text(text)
        return json.loads(text)

    def quickest(self, scene, presets, more, takes=2):
        """Interleaved repetitions: of each preset the statistics with the quickest shadow passes."""
        runs = {preset: [] for preset in presets}
        for take in range(takes):
            for preset in presets:
                runs[preset].append(self.run("render", scene, ["--preset", preset, *more], take))
        return {preset: min(all_takes, key=shadow_ms) for preset, all_takes in runs.items()}


def shadow_ms(stats):
    return sum(time for name, time in stats["passes"].items() if name not in HOST)


def row(cells):
    print("| " + " | ".join(str(cell) for cell in cells) + " |", flush=True)


def table(title, head):
    print(f"\n{title}\n")
    row(head)
    row(["---"] + ["---:"] * (len(head) - 1))


def millions(count):
    return f"{count / 1e6:.2f}"


def percent(fraction):
    return f"{100 * fraction:.3f}"


def triangles(program):
    table("Triangles drawn, million (triangle, view) pairs, 1280×720, budget 2048 MiB", ["Scene", *CULLING, "naive / PMCD", "naive / PMCD-EB", "naive / default"])
    for scene in LARGE:
        drawn = {preset: program.run("render", scene, ["--preset", preset, *SIZE])["triangles_drawn"] for preset in CULLING}
        ratios = [f"{drawn['naive'] / drawn[preset]:.1f}" for preset in ("PMCD", "PMCD-EB", "default")]
        row([scene, *(millions(drawn[preset]) for preset in CULLING), *ratios])


def texels(program):
    table("Texels allocated, million, 1280×720, budget 2048 MiB; PMCD-EB has 4 maps per light", ["Scene", "lighting computations", *MAPS])
    for scene in LARGE:
        stats = {preset: program.run("render", scene, ["--preset", preset, *SIZE]) for preset in MAPS}
        row([scene, millions(stats["default"]["lighting_computations"]), *(millions(stats[preset]["texels_allocated"]) for preset in MAPS)])


def bounds(program):
    pairs = [("PMC", "PMC-EB"), ("PMCD", "PMCD-EB")]
    table("Saved by explicit bounds, %, 1280×720", ["Scene", "texels", *(f"triangles, {cell} → {tight}" for cell, tight in pairs)])
    for scene in LARGE:
        stats = {preset: program.run("render", scene, ["--preset", preset, *SIZE]) for pair in pairs for preset in pair}
        saved = lambda cell, tight, what: f"{100 * (1 - stats[tight][what] / stats[cell][what]):.0f}"
        row([scene, saved("PMC", "PMC-EB", "texels_allocated"), *(saved(*pair, "triangles_drawn") for pair in pairs)])


def needs(program):
    table("Allocated and drawn by default over the oracle's need, 1280×720, budget 2048 MiB",
          ["Scene", "texels, M", "needed, M", "ratio", "triangles, M", "needed, M", "ratio", "lighting computations, M"])
    for scene in LARGE:
        s = program.run("compare", scene, SIZE)
        ratio = lambda have, need: [millions(s[have]), millions(s[need]), f"{s[have] / max(1, s[need]):.1f}"]
        row([scene, *ratio("texels_allocated", "texels_needed"), *ratio("triangles_drawn", "triangles_needed"), millions(s["lighting_computations"])])


def errors(program):
    table("Wrong visibility of default, % of evaluated pixel×light pairs, 640×360, budget 256 MiB",
          ["Scene", "3 pixels", "texel", "maps", "texels, M", "lighting computations, M", "triangles, M", "lights coarser", "unbacked taps"])
    for scene in ALL:
        s = program.run("compare", scene, SMALL)
        row([scene, percent(s["wrong_outside_band"]), percent(s["wrong_outside_texel_band"]), s["shadow_maps"], millions(s["texels_allocated"]),
             millions(s["lighting_computations"]), millions(s["triangles_drawn"]), s["lights_degraded"], s["unbacked_taps"]])


def presets(program):
    names = ["PMCD-EB", "PMC", "CFM", "u4", "fixed-cubes"]
    table("Wrong visibility of the paper's presets outside the texel band, %, 640×360, budget 256 MiB", ["Scene", *names])
    for scene in LARGE:
        row([scene, *(percent(program.run("compare", scene, ["--preset", name, *SMALL])["wrong_outside_texel_band"]) for name in names)])


def starved(program):
    budgets = ["256", "64", "16", "4"]
    table("default with little memory, 640×360: wrong outside the texel band, % / outside 3 pixels, % / lights coarser", ["Scene", *(f"{b} MiB" for b in budgets), "unbacked taps"])
    for scene in LARGE:
        runs = [program.run("compare", scene, [*SMALL, *(["--budget", budget] if budget != "256" else [])]) for budget in budgets]
        row([scene, *(f"{percent(s['wrong_outside_texel_band'])} / {percent(s['wrong_outside_band'])} / {s['lights_degraded']}" for s in runs),
             sum(s["unbacked_taps"] for s in runs)])


def times(program):
    names = ["default", "PMCD-EB", "fixed-cubes"]
    table("Shadow passes, ms, 1280×720, budget 2048 MiB", ["Scene", *names, "PMCD-EB / default", "fixed-cubes / default"])
    for scene in LARGE:
        ms = {name: shadow_ms(stats) for name, stats in program.quickest(scene, names, [*SIZE, "--frames", "3"]).items()}
        row([scene, *(f"{ms[name]:.0f}" for name in names), *(f"{ms[name] / ms['default']:.2f}" for name in names[1:])])


def stages(program):
    groups = {
        "batch boxes, trees": ["batch bounds", "caster tree", "light tree"],
        "clusters, light lists": ["assign clusters", "compact clusters", "light lists"],
        "resolutions, maps": ["views", "resolutions", "choose maps"],
        "mark": ["reach boxes", "mark pages", "mark texels"],
        "budget, place, clear": ["fit budget", "place pages", "clear pages"],
        "cull": ["count items", "write items"],
        "raster": ["rasterize triangles", "bin triangles", "draw tiles"],
        "G-buffer": ["gbuffer"],
        "shade": ["shade"],
    }
    table("Stages of default, ms, 1280×720, budget 2048 MiB", ["Scene", *groups, "other"])
    for scene in LARGE:
        passes = program.quickest(scene, ["default"], [*SIZE, "--frames", "3"])["default"]["passes"]
        known = [sum(passes.get(name, 0) for name in names) for names in groups.values()]
        row([scene, *(f"{time:.1f}" for time in known), f"{sum(passes.values()) - sum(known):.1f}"])


def levels(program):
    table("Levels of detail, default without and with them, 640×360",
          ["Scene", "triangles, M", "with", "rasterize, ms", "with", "frame, ms", "with", "frame without / with", "wrong outside 3 pixels, %", "with"])
    for scene in LARGE:
        choices = [["--set", "caster_error_percent=0"], []]
        takes = [[program.run("render", scene, [*SMALL, "--frames", "3", *choice], take) for choice in choices] for take in range(5)]
        frames = [min((one[i] for one in takes), key=lambda stats: stats["frame_ms"]) for i in range(2)]
        raster = [min(one[i]["passes"].get("rasterize triangles", 0) for one in takes) for i in range(2)]
        wrong = [program.run("compare", scene, [*SMALL, *choice])["wrong_outside_band"] for choice in choices]
        pairs = [[millions(stats["triangles_drawn"]) for stats in frames], [f"{ms:.0f}" for ms in raster], [f"{stats['frame_ms']:.0f}" for stats in frames]]
        row([scene, *(cell for pair in pairs for cell in pair), f"{frames[0]['frame_ms'] / frames[1]['frame_ms']:.2f}", *map(percent, wrong)])


def recording(program):
    lights = ["16", "64", "256", "1024", "4096"]
    table("CPU time of recording, ms, builtin:houses-lod with random lights, 320×180, the quickest of five runs", ["Preset", *lights, "4096 / 16"])
    for preset in ("default", "PMCD-EB", "fixed-cubes"):
        ms = [min(program.run("render", "builtin:houses-lod", ["--preset", preset, "--size", "320x180", "--frames", "6", "--no-scene-lights", "--random-lights", n], take)["cpu_record_ms"]
                  for take in range(5)) for n in lights]
        row([preset, *(f"{time:.3f}" for time in ms), f"{ms[-1] / ms[0]:.2f}"])


def writers(program):
    table("The page pool's two rasterisers, ms of their passes, 1280×720, budget 2048 MiB", ["Scene", "triangles drawn, M", "compute", "fragments", "fragments / compute"])
    raster = lambda stats: sum(time for name, time in stats["passes"].items() if name in ("rasterize triangles", "bin triangles", "draw tiles", "raster fragments"))
    for scene in LARGE:
        takes = {name: [program.run("render", scene, [*SIZE, "--frames", "3", "--set", f"writer={name}"], take) for take in range(2)] for name in ("compute", "fragments")}
        ms = {name: min(raster(stats) for stats in runs) for name, runs in takes.items()}
        row([scene, millions(takes["compute"][0]["triangles_drawn"]), f"{ms['compute']:.0f}", f"{ms['fragments']:.0f}", f"{ms['fragments'] / ms['compute']:.2f}"])


TABLES = [triangles, texels, bounds, needs, errors, presets, starved, times, stages, levels, recording, writers]

parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
parser.add_argument("program")
parser.add_argument("scenes_dir")
parser.add_argument("tables", nargs="*", metavar="TABLE", help=", ".join(t.__name__ for t in TABLES))
parser.add_argument("--keep", metavar="FOLDER")
options = parser.parse_intermixed_args()
unknown = set(options.tables) - {t.__name__ for t in TABLES}
if unknown:
    parser.error(f"no table {', '.join(sorted(unknown))}")
for one in TABLES:
    if not options.tables or one.__name__ in options.tables:
        one(Program(options.program, options.scenes_dir, options.keep))
