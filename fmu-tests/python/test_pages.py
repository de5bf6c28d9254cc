"""The pages of `cargo xtask run --page`: that the animation draws in a browser without a complaint, and that both need nothing but themselves."""

import re
import shutil
import struct
import subprocess
import zlib

import motion
import pytest

BROWSER = next(filter(None, map(shutil.which, ["chromium", "chromium-browser", "google-chrome"])), None)
needs_browser = pytest.mark.skipif(not BROWSER, reason="neither chromium nor google-chrome is installed: the animation is not drawn")
STOP = 1.0


@pytest.fixture(scope="module")
def pages(xtask, flume, tmp_path_factory):
    """A second of the flume scene in waves."""
    folder = tmp_path_factory.mktemp("pages")
    names = motion.POSE + motion.RATE + motion.ACCELERATION
    rows = [[k / 100, *(x for values in motion.rising(k / 100) for x in values)] for k in range(101)]
    lines = [",".join(["time", *names]), *(",".join(map(repr, row)) for row in rows)]
    (folder / "sea.csv").write_text("\n".join(lines) + "\n", encoding="utf-8")
    (folder / "page").mkdir()
    (folder / "page" / "kept.txt").write_text("the user's own", encoding="utf-8")
    done = xtask("run", flume.path, "--input", folder / "sea.csv", "--step", "0.01", "--output", folder / "out.csv", "--page", folder / "page")
    assert done.returncode == 0, done.stderr
    assert done.stdout.splitlines() == [str(folder / "out.csv"), str(folder / "page" / "index.html")]
    return folder / "page"


def test_exact_the_pages_load_nothing_and_leave_other_files_alone(pages):
    assert sorted(path.name for path in pages.iterdir()) == ["animation.html", "index.html", "kept.txt"]
    for name in ["animation.html", "index.html"]:
        text = (pages / name).read_text(encoding="utf-8")
        # The one address is SVG's name space.
        assert set(re.findall(r"https?://[^\"' ]+", text)) <= {"http://www.w3.org/2000/svg"}
        assert not re.search(r"<(script|img|iframe)[^>]+src=|@import|url\(|fetch\(|XMLHttpRequest|<link[^>]+href=\"(?!data:)", text)
    index = (pages / "index.html").read_text(encoding="utf-8")
    for part in ["Detachment and slack", "Extremes", "Load cycles of winch.tension", "Levels that winch.tension exceeds", "animation.html"]:
        assert part in index, part


def browse(page, tmp_path, *options):
    command = [BROWSER, "--headless", "--no-sandbox", "--disable-gpu", "--hide-scrollbars", "--window-size=900,640", "--virtual-time-budget=2000"]
    command += ["--enable-logging=stderr", f"--user-data-dir={tmp_path / 'browser'}", *options, page]
    done = subprocess.run(command, capture_output=True, text=True, encoding="utf-8", timeout=60)
    assert done.returncode == 0, done.stderr
    console = [line for line in done.stderr.splitlines() if "CONSOLE" in line]
    assert not console, console
    return done.stdout


@needs_browser
@pytest.mark.parametrize("view", ["xz", "yz", "orbit"])
def test_exact_the_animation_draws(pages, tmp_path, view):
    dom = browse((pages / "animation.html").as_uri() + f"#t=0.5&view={view}", tmp_path, "--dump-dom")
    assert f'data-frames="{25 * STOP + 1:.0f}"' in dom, "25 frames a second and the first"
    assert "data-error" not in dom
    assert "t = 0.50 s" in dom


@needs_browser
def test_exact_the_picture_is_not_blank(pages, tmp_path):
    picture = tmp_path / "picture.png"
    browse((pages / "animation.html").as_uri(), tmp_path, f"--screenshot={picture}")
    width, height, rows = pixels(picture.read_bytes())
    # The left pane between its label and its ruler: cable and winch are dark, the sea is pale blue. The body at the lower end is orange.
    across = range(30, width // 2 - 10)
    pane = [rows[y][x] for y in range(80, 320) for x in across]
    dark = sum(max(p) < 90 for p in pane)
    sea = sum(p[2] > p[0] + 8 and min(p) > 180 for p in pane)
    body = sum(p[0] > p[2] + 100 for y in range(320, 362) for p in [rows[y][x] for x in across])
    # Not drawn, each is zero. The cable is some hundred pixels long, the sea a good part of the pane, the body's dot 10 px wide.
    assert dark > 100 and sea > 0.05 * len(pane) and body > 30, (dark, sea, body)


def pixels(png):
    """Width, height and rows of (r, g, b) of a PNG with 8 bits a channel; no picture library among the requirements."""
    at, data, header = 8, b"", None
    while at < len(png):
        (length,), kind = struct.unpack(">I", png[at : at + 4]), png[at + 4 : at + 8]
        body = png[at + 8 : at + 8 + length]
        header = struct.unpack(">IIBBBBB", body) if kind == b"IHDR" else header
        data += body if kind == b"IDAT" else b""
        at += 12 + length
    width, height, depth, colour = header[:4]
    assert depth == 8 and colour in (2, 6) and header[6] == 0, header
    n = 3 if colour == 2 else 4
    raw, above, rows = zlib.decompress(data), bytearray(width * n), []
    for y in range(height):
        start = y * (width * n + 1)
        rule, line = raw[start], bytearray(raw[start + 1 : start + 1 + width * n])
        for i in range(len(line) if rule else 0):
            a, b, c = (line[i - n] if i >= n else 0), above[i], (above[i - n] if i >= n else 0)
            nearest = min((a, b, c), key=lambda v: abs(a + b - c - v))
            line[i] = (line[i] + [0, a, b, (a + b) // 2, nearest][rule]) & 255
        rows.append([tuple(line[i : i + 3]) for i in range(0, len(line), n)])
        above = line
    return width, height, rows
