#!/bin/sh
# Whether this machine's GPU draws what kelir's native code draws, and how fast and exact both are: four minutes at most. It needs
# Linux with glibc GLIBC or later and a Vulkan driver; no compiler, no network. The figures go to FILE too.
#
#     sh run.sh [FILE]
#
# Exit status: 0 where every comparison holds.
here=$(cd "$(dirname "$0")" && pwd) || exit 1
if ! "$here/kelir" --version; then
    echo "kelir does not start here: it needs Linux with glibc GLIBC or later" >&2
    exit 1
fi
exec "$here/kelir" bench gpu "$here/scenes/benchmark.toml" --json "${1:-gpu-check.json}"
