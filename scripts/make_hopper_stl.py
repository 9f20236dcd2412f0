#!/usr/bin/python3
"""Writes the STL surface of a hopper, a pipe over a cone: make_hopper_stl.py file radius outlet_radius cone_height
pipe_height [facets round]. Axis z, outlet at z = 0, lengths in m. The surface is open at both ends: use it with side
both."""
import math
import struct
import sys


def main():
    file, radius, outlet, cone, pipe = sys.argv[1], *map(float, sys.argv[2:6])
    n = int(sys.argv[6]) if len(sys.argv) > 6 else 72
    rings = [(outlet, 0.0), (radius, cone), (radius, cone + pipe)]
    at = lambda k, ring: (ring[0] * math.cos(2 * math.pi * k / n), ring[0] * math.sin(2 * math.pi * k / n), ring[1])
    facets = []
    for low, high in zip(rings, rings[1:]):
        for k in range(n):
            a, b, c, d = at(k, low), at(k + 1, low), at(k + 1, high), at(k, high)
            facets += [(a, b, c), (a, c, d)]
    with open(file, "wb") as out:
        out.write(b"hopper made by make_hopper_stl.py".ljust(80) + struct.pack("<I", len(facets)))
        for a, b, c in facets:
            u, v = [q - p for p, q in zip(a, b)], [q - p for p, q in zip(a, c)]
            normal = (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])
            size = math.sqrt(sum(x * x for x in normal))
            out.write(struct.pack("<12fH", *(x / size for x in normal), *a, *b, *c, 0))


if __name__ == "__main__":
    main()
