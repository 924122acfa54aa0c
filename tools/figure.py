"""Figures with two axes as SVG, for the tables of `scripts/bench`: a plotting library is not asked for."""
import csv
import math

COLOURS = ("#1b6ca8", "#c1440e", "#3a7d44", "#7b4fa3", "#8a6d1b", "#444444")
STYLE = ".grid{stroke:#ddd}.line{fill:none;stroke-width:2}"


def rows(path):
    """The rows of a table, by column; comments are left out."""
    with open(path, encoding="utf-8") as table:
        return list(csv.DictReader(line for line in table if not line.startswith("#")))


class Axis:
    """One axis: `ticks` are (value, label); positions go from `low` to `high` [pixels]."""

    def __init__(self, label, ticks, span, logarithmic=True):
        self.label, self.ticks, self.span = label, ticks, span
        self.scale = math.log if logarithmic else float
        self.low = self.high = 0.0

    def at(self, value):
        a, b = map(self.scale, self.span)
        return self.low + (self.scale(min(max(value, self.span[0]), self.span[1])) - a) / (b - a) * (self.high - self.low)


class Figure:
    def __init__(self, x, y, width=660, height=400, left=66, right=210, top=16, bottom=48):
        self.x, self.y, self.width = x, y, width
        x.low, x.high, y.low, y.high = left, width - right, height - bottom, top
        self.legend = top + 14
        self.out = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" font-family="sans-serif" font-size="12">',
                    f"<style>{STYLE}</style>", f'<rect width="{width}" height="{height}" fill="white"/>']
        for value, label in x.ticks:
            self.add(f'<path d="M{x.at(value):.1f} {top}V{height - bottom}" class="grid"/>')
            self.text(x.at(value), height - bottom + 16, label)
        for value, label in y.ticks:
            self.add(f'<path d="M{left} {y.at(value):.1f}H{width - right}" class="grid"/>')
            self.text(left - 6, y.at(value) + 4, label, "end")
        self.text((left + width - right) / 2, height - 10, x.label)
        middle = (top + height - bottom) / 2
        self.text(14, middle, y.label, extra=f'transform="rotate(-90 14 {middle:.1f})"')

    def add(self, element):
        self.out.append(element)

    def text(self, x, y, content, anchor="middle", extra=""):
        content = content.replace("&", "&amp;").replace("<", "&lt;")
        self.add(f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}" {extra}>{content}</text>')

    def line(self, points, colour, dash=""):
        path = " ".join(f"{self.x.at(x):.1f},{self.y.at(y):.1f}" for x, y in points)
        self.add(f'<polyline points="{path}" class="line" stroke="{colour}" stroke-dasharray="{dash}"/>')

    def dots(self, points, colour, radius=3):
        for x, y in points:
            self.add(f'<circle cx="{self.x.at(x):.1f}" cy="{self.y.at(y):.1f}" r="{radius}" fill="{colour}"/>')

    def entry(self, label, colour, dash=None):
        """A line of the legend; a dot where `dash` is None."""
        left = self.x.high + 8
        if dash is None:
            self.add(f'<circle cx="{left + 11:.1f}" cy="{self.legend}" r="3" fill="{colour}"/>')
        else:
            self.add(f'<path d="M{left:.1f} {self.legend}h22" class="line" stroke="{colour}" stroke-dasharray="{dash}"/>')
        self.text(left + 26, self.legend + 4, label, "start", 'font-size="10"')
        self.legend += 18

    def series(self, points, label, colour, dash=""):
        points = sorted(points)
        self.line(points, colour, dash)
        self.dots(points, colour)
        self.entry(label, colour, dash)

    def svg(self):
        return "\n".join([*self.out, "</svg>"])


def decades(low, high, label=lambda v: f"{v:g}", steps=(1,)):
    """Ticks at `steps` of every power of ten from `low` to `high`."""
    ticks = [s * 10.0 ** k for k in range(math.floor(math.log10(low)), math.ceil(math.log10(high)) + 1) for s in steps]
    return [(t, label(t)) for t in ticks if low * 0.999 <= t <= high * 1.001]
