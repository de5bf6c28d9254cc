"""Line charts as SVG and a page around them, in plain text: the examples need no plotting library."""

import html
import math
from dataclasses import dataclass

# Colours that the colour-blind tell apart (Okabe & Ito).
BLACK, BLUE, ORANGE, GREEN, RED, PURPLE = "#333333", "#0072b2", "#e69f00", "#009e73", "#d55e00", "#cc79a7"

WIDTH, HEIGHT = 900, 230
LEFT, RIGHT, TOP, BOTTOM = 66, 14, 30, 40


@dataclass
class Line:
    """A curve with its name in the legend."""

    name: str
    x: list
    y: list
    colour: str = BLUE
    dashed: bool = False
    marks: bool = False


def ticks(low, high, wanted):
    """Round numbers between two values."""
    raw = (high - low) / wanted
    power = 10.0 ** math.floor(math.log10(raw))
    step = next(f * power for f in (1, 2, 2.5, 5, 10) if f * power >= raw * (1 - 1e-9))
    first = math.ceil(low / step - 1e-9)
    return [k * step for k in range(first, math.floor(high / step + 1e-9) + 1)], step


def number(value, step):
    """A tick's text, with as many decimals as the step has."""
    decimals = max(0, -math.floor(math.log10(step) + 1e-9))
    if decimals < 6 and abs(round(step, decimals) - step) > 1e-9 * step:
        decimals += 1
    return f"{value + 0.0:.{decimals}f}".replace("-", "\N{MINUS SIGN}")


def thinned(line, most=1200):
    """A curve's points, of each stretch the lowest and the highest, so that no peak is lost."""
    x, y = list(map(float, line.x)), list(map(float, line.y))
    stretch = 2 * math.ceil(len(x) / most)
    if stretch < 4:
        return x, y
    kept = [0]
    for k in range(0, len(x), stretch):
        part = range(k, min(k + stretch, len(x)))
        kept += sorted({min(part, key=y.__getitem__), max(part, key=y.__getitem__)})
    kept = sorted({*kept, len(x) - 1})
    return [x[k] for k in kept], [y[k] for k in kept]


def chart(title, lines, x_label, y_label, height=HEIGHT, zero=False, whole=False, logarithmic=False):
    """SVG text; `zero` draws the y axis from zero on, `whole` marks whole numbers of x only, `logarithmic` takes decimal logarithms of both."""
    curves = [(line, *thinned(line)) for line in lines]
    curves = [(line, *zip(*[(a, b) for a, b in zip(x, y) if math.isfinite(a) and math.isfinite(b)])) for line, x, y in curves]
    if logarithmic:
        curves = [(line, [math.log10(a) for a in x], [math.log10(b) for b in y]) for line, x, y in curves]
    all_x, all_y = [a for _, x, _ in curves for a in x], [b for _, _, y in curves for b in y]
    (x0, x1), (y0, y1) = (min(all_x), max(all_x)), (min(all_y + [0.0] * zero), max(all_y))
    if x1 == x0:
        x0, x1 = x0 - 0.5, x1 + 0.5
    margin = 0.06 * (y1 - y0) or 0.05 * abs(y1) or 1.0
    y0, y1 = y0 - (0.0 if zero and y0 >= 0.0 else margin), y1 + margin
    if logarithmic:
        x0, x1 = x0 - 0.05, x1 + 0.05
    inner, tall = WIDTH - LEFT - RIGHT, height - TOP - BOTTOM
    px = lambda a: LEFT + inner * (a - x0) / (x1 - x0)
    py = lambda b: TOP + tall * (y1 - b) / (y1 - y0)
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {height}" font-family="sans-serif" font-size="12" fill="#333">']
    out.append(f'<rect width="{WIDTH}" height="{height}" fill="#fff"/>')
    out.append(f'<text x="{LEFT}" y="18" font-size="13" font-weight="bold">{html.escape(title)}</text>')
    power = lambda k, _: f"{10.0**k:.0e}" if k < -3 or k > 4 else f"{10.0**k:g}"
    for vertical, (low, high, wanted) in ((False, (x0, x1, 8)), (True, (y0, y1, 4))):
        marks, step = ticks(low, high, wanted)
        if whole and not vertical:
            marks, step = list(range(math.ceil(low), math.floor(high) + 1)), 1
        text = number
        if logarithmic:
            marks = [k + math.log10(f) for k in range(math.floor(low), math.ceil(high) + 1) for f in (1, 2, 5)]
            marks = [m for m in marks if low <= m <= high]
            marks = [m for m in marks if vertical is False or len(marks) < 8 or abs(m - round(m)) < 1e-9]
            text = power
        for mark in marks:
            if vertical:
                out.append(f'<path d="M{LEFT} {py(mark):.1f}h{inner}" stroke="#ddd"/>')
                out.append(f'<text x="{LEFT - 6}" y="{py(mark) + 4:.1f}" text-anchor="end">{text(mark, step)}</text>')
            else:
                out.append(f'<path d="M{px(mark):.1f} {TOP}v{tall}" stroke="#eee"/>')
                out.append(f'<text x="{px(mark):.1f}" y="{TOP + tall + 15}" text-anchor="middle">{text(mark, step)}</text>')
    out.append(f'<rect x="{LEFT}" y="{TOP}" width="{inner}" height="{tall}" fill="none" stroke="#999"/>')
    out.append(f'<text x="{LEFT + inner / 2}" y="{height - 7}" text-anchor="middle">{html.escape(x_label)}</text>')
    middle = TOP + tall / 2
    out.append(f'<text x="14" y="{middle}" text-anchor="middle" transform="rotate(-90 14 {middle})">{html.escape(y_label)}</text>')
    for line, x, y in curves:
        points = " ".join(f"{px(a):.1f},{py(b):.1f}" for a, b in zip(x, y))
        dash = ' stroke-dasharray="6 4"' if line.dashed else ""
        out.append(f'<polyline points="{points}" fill="none" stroke="{line.colour}" stroke-width="1.4" stroke-linejoin="round"{dash}/>')
        if line.marks:
            out += [f'<circle cx="{px(a):.1f}" cy="{py(b):.1f}" r="3.5" fill="{line.colour}"/>' for a, b in zip(x, y)]
    # The legend stands on the right of the title.
    right = WIDTH - RIGHT
    for line in reversed(lines):
        right -= 7 * len(line.name) + 34
        dash = ' stroke-dasharray="6 4"' if line.dashed else ""
        out.append(f'<path d="M{right} 14h20" stroke="{line.colour}" stroke-width="2.5"{dash}/>')
        out.append(f'<text x="{right + 25}" y="18">{html.escape(line.name)}</text>')
    return "\n".join(out + ["</svg>"]) + "\n"


STYLE = """body { font: 15px/1.5 sans-serif; color: #333; max-width: 960px; margin: 2em auto; padding: 0 1em }
h1 { font-size: 1.5em } h2 { font-size: 1.15em; margin-top: 2em }
.wide { overflow-x: auto } table { border-collapse: collapse; font-size: 13px }
th, td { padding: 3px 9px; border-bottom: 1px solid #ddd; text-align: right }
th { border-bottom: 2px solid #999; vertical-align: bottom } td:nth-child(-n+2), th:nth-child(-n+2) { text-align: left; white-space: nowrap }
tr.first td { border-top: 2px solid #bbb } svg { width: 100%; height: auto; display: block; margin: .6em 0 }"""


def html_table(head, rows):
    """A table; a line is drawn where the first column changes."""
    row = lambda cells, tag: "".join(f"<{tag}>{html.escape(cell)}</{tag}>" for cell in cells)
    body, last = [], None
    for cells in rows:
        mark = ' class="first"' if last is not None and cells[0] != last else ""
        body.append(f"<tr{mark}>{row(cells, 'td')}</tr>")
        last = cells[0]
    return f'<div class="wide"><table><tr>{row(head, "th")}</tr>\n' + "\n".join(body) + "</table></div>\n"


def page(title, parts):
    """A page of HTML parts."""
    head = f'<!doctype html><html lang="en"><meta charset="utf-8"><title>{html.escape(title)}</title><style>{STYLE}</style>'
    return f"{head}<h1>{html.escape(title)}</h1>\n" + "\n".join(parts) + "</html>\n"
