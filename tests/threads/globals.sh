#!/usr/bin/env bash
# The library has no variable that outlives a call but constants, which are named kLikeThis or listed here, the names of temporary
# files, which are atomic, and each thread's own FileGate, AllowedFolder and Budget while one lives. SPDX-License-Identifier: MIT
#     globals.sh LIBRARY.a...
set -euo pipefail
constants='::k[A-Z][A-Za-z0-9]*(\[abi:cxx11\])?$|::white$|::limited$|known_displays\(\)::displays$|ward_veil\(double\)::scattered$'
others=$(nm -C "$@" 2>/dev/null | sed -n 's/^[0-9a-f]\+ [bBdDu] //p' | grep '^vesper' | grep -vE "$constants|\(anonymous namespace\)::(slots|gate|allowed|budget)\$" || true)
[[ -z $others ]] && exit 0
echo "variables that are not known to be constants:"
echo "$others"
exit 1
