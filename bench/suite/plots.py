"""Plots as SVG, by gnuplot: the same bytes for the same figures, so that a change of a picture is a
change of what it shows."""
import subprocess

STYLE = """
set terminal svg size {width},{height} font 'sans-serif,12' background '#ffffff'
set output
set encoding utf8
set border 3 lc '#666666'
set tics nomirror out
set grid y lc '#dddddd' lt 1 lw 0.5
set key {key} reverse Left samplen 1.5
set title "{title}" font ',13' noenhanced
set xlabel "{xlabel}" noenhanced
set ylabel "{ylabel}" noenhanced
"""
COLOURS = ("#1f5a96", "#d1762c", "#4a8c3f", "#a33b3b", "#7a5aa6", "#7d6a4f", "#3b9aa3", "#888888")


def quoted(text):
    return '"' + str(text).replace("\\", "\\\\").replace('"', '\\"') + '"'


def style(title, xlabel, ylabel, key, width=720, height=400):
    return STYLE.format(title=title, xlabel=xlabel, ylabel=ylabel, key=key, width=width, height=height)


def draw(path, script):
    svg = subprocess.run(["gnuplot"], input=script, text=True, capture_output=True)
    if svg.returncode != 0 or svg.stderr:
        raise RuntimeError(f"gnuplot: {svg.stderr}")
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(svg.stdout)


def block(name, rows):
    return f"${name} << END\n" + "\n".join(" ".join(str(word) for word in row) for row in rows) + "\nEND\n"


def bars(path, title, xlabel, rows):
    """A bar for each row (label, median, least, greatest), with the spread as a whisker."""
    longest = max(greatest for _, _, _, greatest in rows)
    script = style(title, xlabel, "", "off", height=90 + 26 * len(rows))
    script += "set style fill solid 0.85 noborder\nset ytics scale 0 noenhanced\n"
    script += "unset grid\nset grid x lc '#dddddd' lt 1 lw 0.5\n"
    script += f"set yrange [{-len(rows) + 0.4}:0.6]\nset xrange [0:{1.12 * longest:g}]\n"
    script += block("rows", [(-number, quoted(label), middle, least, greatest)
                             for number, (label, middle, least, greatest) in enumerate(rows)])
    script += (f"plot $rows using (0):1:(0):3:($1-0.34):($1+0.34):ytic(2) with boxxyerror lc '{COLOURS[0]}',"
               " $rows using 4:1:($5-$4):(0) with vectors nohead lc '#d1762c' lw 2,"
               " $rows using 5:1:(sprintf('%.3g', $3)) with labels left offset 0.7,0\n")
    draw(path, script)


def lines(path, title, xlabel, ylabel, series, logarithmic="", key="top left"):
    """Lines through the points (x, median, least, greatest) of each series {label: points}.

    `logarithmic` names the axes that are: "", "x", "y" or "xy".
    """
    script = style(title, xlabel, ylabel, key) + "set bars small\nset offsets graph 0.03, graph 0.03\n"
    if logarithmic:
        script += f"set logscale {logarithmic}\n"
    if "y" not in logarithmic:
        script += "set yrange [0:*]\n"
    plotted = []
    for number, (label, points) in enumerate(series.items()):
        script += block(f"series{number}", sorted(points))
        colour = COLOURS[number % len(COLOURS)]
        plotted.append(f"$series{number} using 1:2:3:4 with yerrorlines lc '{colour}' pt 7 ps 0.5"
                       f" lw 1.6 title {quoted(label)} noenhanced")
    draw(path, script + "plot " + ", \\\n  ".join(plotted) + "\n")


def dots(path, title, xlabel, ylabel, series, logarithmic=""):
    """Small dots at the places (x, y) of each series {label: places}."""
    script = style(title, xlabel, ylabel, "outside top horizontal")
    if logarithmic:
        script += f"set logscale {logarithmic}\n"
    plotted = []
    for number, (label, places) in enumerate(series.items()):
        script += block(f"series{number}", places)
        colour = COLOURS[number % len(COLOURS)]
        plotted.append(f"$series{number} using 1:2 with points lc '{colour}' pt 7 ps 0.15"
                       f" title {quoted(label)} noenhanced")
    draw(path, script + "plot " + ", \\\n  ".join(plotted) + "\n")
