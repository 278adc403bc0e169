#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
#
# Installs what is needed (Debian, Ubuntu), builds everything and runs all tests.
# usage: test/run.sh [preset], one of CMakePresets.json; release by default
set -euo pipefail

repo=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
preset=${1:-release}

"$repo/src/cmake/apt_install.sh" g++ make cmake pkg-config \
  libpcl-dev libeigen3-dev libboost-program-options-dev nlohmann-json3-dev libxsimd-dev libgtest-dev \
  libbenchmark-dev libcgal-demo

# Point sets the tests read: those of Debian's CGAL, and the project's own where they are at hand.
cgal_data="$repo/build/cgal"
if [[ ! -e $cgal_data/complete ]]; then
  mkdir -p "$cgal_data"
  tar -xzf /usr/share/doc/libcgal-dev/data.tar.gz -C "$cgal_data" --strip-components=1 data/points_3 data/meshes
  touch "$cgal_data/complete"
fi
export ERKPA_CGAL_DATA="$cgal_data"
if [[ -z ${ERKPA_TEST_DATA:-} && -d $repo/../shared/data ]]; then
  ERKPA_TEST_DATA=$(cd "$repo/../shared/data" && pwd)
  export ERKPA_TEST_DATA
fi

jobs=$("$repo/src/cmake/build_jobs.sh")
cd "$repo"
cmake --preset "$preset"
cmake --build --preset "$preset" --parallel "$jobs"
ctest --preset "$preset" --parallel "$jobs"
