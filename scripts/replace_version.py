#!/usr/bin/env python3
"""Lets libraries ask for an older version of symbols, where a system's library lacks the newer one.

    scripts/replace_version.py VERSION LIBRARY...

In the libraries' lists of needed versions (.gnu.version_r, 64-bit ELF) the entry of VERSION, such as GLIBC_2.36, becomes a second
one of the oldest that the same list names. Its symbols must then be found in another library, one without versions. Fails where
a library does not name the version, or no other."""
import re
import struct
import sys
from pathlib import Path

VERNEED = 0x6FFFFFFE  # SHT_GNU_verneed


def entries_of_lists(elf: bytearray) -> list[dict[bytes, int]]:
    """Where the entries are, by their versions, for each library that versions are needed of."""
    lists = []
    sections_at, = struct.unpack_from("<Q", elf, 0x28)
    size, count = struct.unpack_from("<HH", elf, 0x3A)
    sections = [struct.unpack_from("<IIQQQQII", elf, sections_at + size * i) for i in range(count)]
    for _, kind, _, _, at, _, strings, needs in sections:
        for _ in range(needs if kind == VERNEED else 0):
            _, names, _, first, further = struct.unpack_from("<HHIII", elf, at)
            entry, entries = at + first, {}
            for _ in range(names):
                _, _, _, name, following = struct.unpack_from("<IHHII", elf, entry)
                begin = sections[strings][4] + name
                entries[bytes(elf[begin:elf.index(0, begin)])] = entry
                entry += following
            lists.append(entries)
            at += further
    return lists


def age_of(version: bytes) -> list[int]:
    return [int(number) for number in re.findall(rb"\d+", version)]


def replace(version: bytes, elf: bytearray) -> bool:
    """Whether a list names it and another."""
    for entries in entries_of_lists(elf):
        others = [other for other in entries if other != version and age_of(other)]
        if version in entries and others:
            digest, _, _, name, _ = struct.unpack_from("<IHHII", elf, entries[min(others, key=age_of)])
            struct.pack_into("<I", elf, entries[version], digest)
            struct.pack_into("<I", elf, entries[version] + 8, name)
            return True
    return False


def main() -> None:
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    for path in map(Path, sys.argv[2:]):
        elf = bytearray(path.read_bytes())
        if elf[:6] != b"\x7fELF\x02\x01":
            sys.exit(f"{path}: no 64-bit ELF file with the low byte first")
        if not replace(sys.argv[1].encode(), elf):
            sys.exit(f"{path}: does not need {sys.argv[1]} and another version of a library")
        path.write_bytes(elf)


if __name__ == "__main__":
    main()
