"""Numbers of the designs by a second implementation, for `numbers_are_pinned` in tests/sampling/designs.rs.

python3 tests/golden/designs.py      (no packages; prints the rows of the table as bits)
"""

import os
import struct

M64 = 2**64 - 1
SEED = 20260101
NAMES = ["initial.angular_velocity_rad_s.x", "fuselage.density_kg_m3"]


def chacha8_block(key, counter):
    state = list(struct.unpack("<16I", b"expand 32-byte k" + key + struct.pack("<QQ", counter, 0)))
    w = state[:]

    def quarter(a, b, c, d):
        for x, y, z, n in ((a, b, d, 16), (c, d, b, 12), (a, b, d, 8), (c, d, b, 7)):
            w[x] = (w[x] + w[y]) & 0xFFFFFFFF
            t = w[z] ^ w[x]
            w[z] = ((t << n) | (t >> (32 - n))) & 0xFFFFFFFF

    for _ in range(4):
        for i in range(4):
            quarter(i, 4 + i, 8 + i, 12 + i)
        for i in range(4):
            quarter(i, 4 + (i + 1) % 4, 8 + (i + 2) % 4, 12 + (i + 3) % 4)
    return struct.pack("<16I", *((a + b) & 0xFFFFFFFF for a, b in zip(w, state)))


assert chacha8_block(bytes(32), 0)[:4].hex() == "3e00ef2f"


def word(name, purpose, index):
    h = 0x6C62272E07BB014262B821756295C58D
    for byte in name.encode():
        h = ((h ^ byte) * 0x0000000001000000000000000000013B) % 2**128
    key = struct.pack("<Q", SEED) + h.to_bytes(16, "little") + purpose
    return struct.unpack("<8Q", chacha8_block(key, index // 8))[index % 8]


def unit(bits):
    return ((bits >> 11) | 1) * 2.0**-53


def mix(x):
    x = ((x ^ (x >> 30)) * 0xBF58476D1CE4E5B9) & M64
    x = ((x ^ (x >> 27)) * 0x94D049BB133111EB) & M64
    return x ^ (x >> 31)


def keyed(key, counter):
    golden = 0x9E3779B97F4A7C15
    return mix(key ^ mix((counter * golden + golden) & M64))


def random(name, sample):
    return unit(word(name, b"sampling", sample))


def permuted(key, place, n):
    half = max(((n - 1).bit_length() + 1) // 2, 4)
    keys = [keyed(key, r) for r in range(6)]
    while True:
        left, right = place >> half, place & (2**half - 1)
        for k in keys:
            left, right = right, left ^ (keyed(k, right) >> (64 - half))
        place = left << half | right
        if place < n:
            return place


def latin(name, sample, n=4096):
    return (permuted(word(name, b"latin   ", 0), sample - 1, n) + random(name, sample)) / n


def directions(dimension):
    if dimension == 0:
        return [1 << (63 - k) for k in range(64)]
    table = os.path.join(os.path.dirname(__file__), "../../assets/joe-kuo-6.512")
    _, s, a, *m = map(int, open(table).read().splitlines()[dimension].split())
    v = [m[k] << (63 - k) for k in range(s)]
    for k in range(s, 64):
        x = v[k - s] ^ (v[k - s] >> s)
        for j in range(1, s):
            if a >> (s - 1 - j) & 1:
                x ^= v[k - j]
        v.append(x)
    return v


def sobol(name, dimension, point):
    bits = 0
    for k, v in enumerate(directions(dimension)):
        if point >> k & 1:
            bits ^= v
    key = word(name, b"sobol   ", 0)
    out = bits ^ (keyed(key, bits >> 32) >> 32)
    for level in range(32):
        out ^= (keyed(key ^ 0x6E6F6465735F6F66, (1 << level) | (bits >> (64 - level))) >> 63) << (63 - level)
    return unit(out)


def halton(name, dimension, point):
    b, key, digits = (2, 3)[dimension], word(name, b"halton  ", 0), 0
    while b ** (digits + 1) <= 2**52:
        digits += 1
    cell = 0
    for digit in range(digits):
        images = list(range(b))
        for i in range(b - 1, 0, -1):
            j = keyed(key, digit * b + i) * (i + 1) >> 64
            images[i], images[j] = images[j], images[i]
        cell = cell * b + images[point % b]
        point //= b
    return (cell + 0.5) / b**digits


def saltelli(dimension, point):
    block, member = divmod(point, 4)
    from_b = member in (3, dimension + 1)
    first = 1 << block.bit_length() >> 1
    level = keyed(word(NAMES[dimension], b"saltelli", 0), first.bit_length() - 1)
    place = first + permuted(level, block - first, first) if block else 0
    return sobol(NAMES[dimension] + ("/B" if from_b else ""), int(from_b), place)


for design, number in {
    "random": lambda d, s: random(NAMES[d], s),
    "latin_hypercube": lambda d, s: latin(NAMES[d], s),
    "sobol": lambda d, s: sobol(NAMES[d], d, s - 1),
    "halton": lambda d, s: halton(NAMES[d], d, s - 1),
    "saltelli": lambda d, s: saltelli(d, s - 1),
}.items():
    rows = [[struct.unpack("<Q", struct.pack("<d", number(d, s)))[0] for d in (0, 1)] for s in (1, 6, 4096)]
    text = ", ".join("[" + ", ".join(f"0x{x:016x}" for x in row) + "]" for row in rows)
    print(f'    ("{design}", [{text}]),')
