#!/usr/bin/env bash
# A short run of a fuzzer, the same each time, from the files of its kind; scripts/fuzz has long ones. SPDX-License-Identifier: MIT
#     short.sh FUZZER READER
set -euo pipefail
found=$PWD/failures
cd "$(dirname "$0")/../.."
source tests/fuzz/seeds.sh
corpus=$(mktemp -d)
trap 'rm -rf "$corpus"' EXIT
plant "$2" "$corpus"
runs=10000
[[ $2 == c_interface || $2 == c_vision ]] && runs=60  # each of them is a frame
mkdir -p "$found"
"$1" -seed=1 -runs=$runs -max_len=8192 -timeout=60 -rss_limit_mb=3000 -malloc_limit_mb=256 -verbosity=0 -artifact_prefix="$found/$2-" "$corpus"
