#!/usr/bin/python3
"""Runs the SQL examples of Markdown files and compares what they print.

    doc_examples.py [--write] FILE...

Every ```sql block is run by psql, all blocks of a file in one session in a
scratch database of the server that the environment names. A ```text block
that follows must be the output; in it, an ellipsis (…) stands for any text
within a line, and a line that is only an ellipsis for any number of lines. A
block without output must run without an error. A block after the line
<!-- not run --> is left alone. --write puts the real output into the files
where it differs.
"""
import re
import subprocess
import sys

BLOCK = re.compile(
    r"(?P<skip><!-- not run[^\n]*-->\n)?"
    r"^```sql\n(?P<sql>.*?)^```\n"
    r"(?:\n*^```text\n(?P<text>.*?)^```\n)?", re.M | re.S)
SEPARATOR = "---- end of example ----"
DATABASE = "abacus_doc_examples"


def psql(*arguments, script=None):
    result = subprocess.run(["psql", "-X", "-q", *arguments], input=script, text=True,
                            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
    return result.stdout


def outputs_of(blocks, create_extension):
    """What psql prints for each block."""
    psql("-d", "postgres", "-c", f"DROP DATABASE IF EXISTS {DATABASE}",
         "-c", f"CREATE DATABASE {DATABASE}")
    script = "SET client_min_messages = notice;\n"
    if create_extension:
        script += "CREATE EXTENSION abacus;\n"
    for sql in blocks:
        script += f"\\echo {SEPARATOR}\n{sql}\n"
    printed = psql("-d", DATABASE, script=script)
    psql("-d", "postgres", "-c", f"DROP DATABASE {DATABASE}")
    outputs = printed.split(SEPARATOR + "\n")[1:]
    return outputs + [""] * (len(blocks) - len(outputs))


def tidy(text):
    return [line.rstrip() for line in text.strip("\n").split("\n")]


def matches(expected, printed):
    lines = []
    for line in tidy(expected):
        if line == "…":
            lines.append(r"(?:[^\n]*\n)*?")
        else:
            lines.append(r"[^\n]*".join(re.escape(part) for part in line.split("…")) + r"\n")
    return re.fullmatch("".join(lines), "\n".join(tidy(printed)) + "\n") is not None


def run_file(path, write):
    """Numbers of examples run and failed."""
    with open(path, encoding="utf-8") as file:
        document = file.read()
    found = [block for block in BLOCK.finditer(document) if not block["skip"]]
    outputs = outputs_of([block["sql"] for block in found],
                         re.search(r"CREATE EXTENSION abacus\b", document) is None)
    failed = 0
    for block, printed in reversed(list(zip(found, outputs))):
        if block["text"] is None:
            wrong = re.search(r"^(ERROR|FATAL|PANIC):", printed, re.M) is not None
        else:
            wrong = not matches(block["text"], printed)
        if not wrong:
            continue
        if write and block["text"] is not None:
            new = "\n".join(tidy(printed)) + "\n"
            document = document[:block.start("text")] + new + document[block.end("text"):]
            continue
        failed += 1
        line = document.count("\n", 0, block.start()) + 1
        print(f"{path}:{line}: the example prints\n{printed}", end="")
        if block["text"] is not None:
            print(f"and should print\n{block['text']}", end="")
    if write:
        with open(path, "w", encoding="utf-8") as file:
            file.write(document)
    return len(found), failed


def main():
    arguments = sys.argv[1:]
    write = "--write" in arguments
    paths = [argument for argument in arguments if argument != "--write"]
    if not paths:
        sys.exit(__doc__)
    total = failed = 0
    for path in paths:
        count, wrong = run_file(path, write)
        total += count
        failed += wrong
    print(f"{total} examples, {failed} failed")
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
