#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
#
# Builds and runs the consumer without CMake.
# usage: pkg_config.sh <directory of erkpa.pc> <work directory> [compiler]
set -euo pipefail

pc_dir=$1
work_dir=$2
compiler=${3:-c++}
source_dir=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)

export PKG_CONFIG_PATH="$pc_dir${PKG_CONFIG_PATH:+:$PKG_CONFIG_PATH}"
mkdir -p "$work_dir"
# shellcheck disable=SC2046 # pkg-config prints a list of words
"$compiler" -std=c++17 -O1 "$source_dir/consumer.cpp" $(pkg-config --cflags --libs erkpa) -o "$work_dir/consumer"
LD_LIBRARY_PATH="$(pkg-config --variable=libdir erkpa)${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}" "$work_dir/consumer"
