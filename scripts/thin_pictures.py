#!/usr/bin/python3
"""Draws the pictures of docs/cookbook/thinning-and-refining.md, from the meshes that its examples make.

It works in a scratch database of the server that the environment names, and writes docs/images/thin_*.png.
"""
import pathlib
import subprocess

from doc_examples import BLOCK

DOCS = pathlib.Path(__file__).resolve().parents[1] / "docs"
DATABASE = "abacus_thin_pictures"
WINDOW = "lower => '{120, 90}', upper => '{280, 210}', width => 480"
PICTURES = {
    "thin_before": f"'ground', {WINDOW}, attribute => 'height', exaggeration => 1.5",
    "thin_after": f"'thin', {WINDOW}, attribute => 'height', exaggeration => 1.5",
    "thin_difference": "'difference', width => 480, attribute => 'difference', edges => false, range => '{-0.25, 0.25}', ramp => 'diverging', legend => 'm'",
}


def psql(database, *commands, script=None):
    arguments = [part for command in commands for part in ("-c", command)]
    return subprocess.run(["psql", "-X", "-q", "-A", "-t", "-v", "ON_ERROR_STOP=1", "-d", database, *arguments],
                          input=script, stdout=subprocess.PIPE, text=True, check=True).stdout


def main():
    text = (DOCS / "cookbook/thinning-and-refining.md").read_text()
    section = text[:text.index("If you can afford")]
    psql("postgres", "SET client_min_messages = warning", f"DROP DATABASE IF EXISTS {DATABASE}", f"CREATE DATABASE {DATABASE}")
    psql(DATABASE, script="".join(block["sql"] for block in BLOCK.finditer(section)))
    for name, arguments in PICTURES.items():
        drawn = psql(DATABASE, f"SELECT encode(abacus_draw({arguments}), 'hex')")
        (DOCS / f"images/{name}.png").write_bytes(bytes.fromhex(drawn))
    psql("postgres", f"DROP DATABASE {DATABASE}")


if __name__ == "__main__":
    main()
