#!/usr/bin/env python3
"""Lets libraries ask for an older version of symbols, where a system's library lacks the newer one.

    scripts/replace_version.py NEWER OLDER LIBRARY...

In the libraries' lists of needed versions (.gnu.version_r, 64-bit ELF) the entry of NEWER becomes a second one of OLDER, which
the same list must name. The symbols of NEWER must then be found in another library, one without versions. Fails where a library
does not name both."""
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


def replace(newer: bytes, older: bytes, elf: bytearray) -> bool:
    """Whether a list names both."""
    for entries in entries_of_lists(elf):
        if newer in entries and older in entries:
            (digest, _, _, name, _), at = struct.unpack_from("<IHHII", elf, entries[older]), entries[newer]
            struct.pack_into("<I", elf, at, digest)
            struct.pack_into("<I", elf, at + 8, name)
            return True
    return False


def main() -> None:
    if len(sys.argv) < 4:
        sys.exit(__doc__)
    newer, older = (version.encode() for version in sys.argv[1:3])
    for path in map(Path, sys.argv[3:]):
        elf = bytearray(path.read_bytes())
        if elf[:6] != b"\x7fELF\x02\x01":
            sys.exit(f"{path}: no 64-bit ELF file with the low byte first")
        if not replace(newer, older, elf):
            sys.exit(f"{path}: does not need both {newer.decode()} and {older.decode()} of a library")
        path.write_bytes(elf)


if __name__ == "__main__":
    main()
