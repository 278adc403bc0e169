#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
#
# Prints how many compilers to run at once: one per processor, but a file that includes PCL takes up to 1.5 GB.
set -euo pipefail

processors=$(nproc)
if [[ -r /proc/meminfo ]]; then
  awk -v most="$processors" '
    /^MemAvailable:/ { jobs = int ($2 / 1500000); print jobs < 1 ? 1 : jobs < most ? jobs : most; found = 1 }
    END { if (!found) print most }' /proc/meminfo
else
  echo "$processors"
fi
