#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
#
# Figures 2, 3, 5 and 6 of the paper (Debian, Ubuntu): installs what is needed, builds, and draws them into
# build/figures. Figure 2 needs no data; the others are drawn where DATA_FOLDER has their points: screwdriver_40722.xyz,
# venus_711.off and happy_buddha_5000.xyz (x y z nx ny nz a line; vertices and faces in the .off).
# usage: figures.sh [DATA_FOLDER]
set -euo pipefail

repo=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
out="$repo/build/figures"
data=$(cd "${1:-.}" && pwd)

"$repo/src/cmake/apt_install.sh" g++ make cmake pkg-config \
  libpcl-dev libeigen3-dev libboost-program-options-dev nlohmann-json3-dev libxsimd-dev python3-vtk9 python3-numpy xvfb xauth

cmake -S "$repo" -B "$out/build" -DERKPA_BUILD_TESTS=OFF --log-level=WARNING
cmake --build "$out/build" --parallel "$("$repo/src/cmake/build_jobs.sh")" --target erkpa_reconstruct bend_and_twist
cd "$out"

reconstruct()
{
  echo "> erkpa_reconstruct $*"
  build/erkpa_reconstruct "$@"
}

draw()
{
  xvfb-run -a /usr/bin/python3 "$repo/samples/figures/render.py" "$@"
  echo "Drawn: $out/$1"
}

# have FIGURE FILE
have()
{
  if [[ ! -r $data/$2 ]]; then
    echo "Figure $1 is left out: there is no $2 in ${data}"
    return 1
  fi
}

papers_method=(-constraint functional -order linear) # "Hermite" in the captions is the default

# ---- Figure 2: a parallelepiped and a twisted one; then the one surface of the first, deformed ----------------------

figure2()
{
  build/samples/bend_and_twist .
  draw figure2.png --columns 3 --width 400 --height 480 --from=1,-1.8,0.9 \
    "(a) 3900 points=box_points.pcd" "(b) classical=box_classical.ply" "(c) enriched=box_enriched.ply" \
    "(d) the same points twisted=twisted_points.pcd" "(e) classical=twisted_classical.ply" \
    "(f) enriched=twisted_enriched.ply"
  draw bend_and_twist.png --columns 3 --width 400 --height 480 --from=1,-1.8,0.9 \
    "the enriched surface=box_enriched.ply" "twisted=box_twisted.ply" "bent=box_bent.ply"
}

# ---- Figure 3: the screwdriver and two planes along its flat tip ----------------------------------------------------

figure3()
{
  local points="$data/screwdriver_40722.xyz"
  # The cross-section of the tip is a flat rectangle; each plane goes through two opposite edges of the four.
  local planes=(-sharp "0.2985,0.9544,-0.0047,0.00557" -sharp "0.2011,-0.9796,0.0039,-0.00519")
  local support=(-radius 0.04 -resolution 280)
  reconstruct "$points" screwdriver_classical.ply "${support[@]}" "${papers_method[@]}"
  reconstruct "$points" screwdriver_enriched.ply "${support[@]}" "${papers_method[@]}" "${planes[@]}" -enrichment jump
  reconstruct "$points" screwdriver_hermite.ply "${support[@]}"
  reconstruct "$points" screwdriver_hermite_enriched.ply "${support[@]}" "${planes[@]}"
  local tip="@0,-0.003,0.42,0.085"
  draw figure3.png --columns 5 --width 260 --height 540 --point-size 2.5 --crease 50 --from=-1,0.6,0.5 \
    "(a) 40722 points=$points" \
    "(b) classical=screwdriver_classical.ply" "(c) two planes along the tip=screwdriver_enriched.ply" \
    "(b) Hermite=screwdriver_hermite.ply" "(c) Hermite=screwdriver_hermite_enriched.ply" \
    "(d)=$points$tip" "(e)=screwdriver_classical.ply$tip" "(f)=screwdriver_enriched.ply$tip" \
    "(e) Hermite=screwdriver_hermite.ply$tip" "(f) Hermite=screwdriver_hermite_enriched.ply$tip"
}

# ---- Figure 5: wider and wider supports, in per cent of the box's largest side, which is 5.25 -----------------------

figure5()
{
  local points="$data/venus_711.off" method=("${papers_method[@]}" -resolution 100) # normals from the faces
  reconstruct "$points" venus_10.ply "${method[@]}" -radius 0.525
  reconstruct "$points" venus_30.ply "${method[@]}" -radius 1.575
  reconstruct "$points" venus_30_sharp.ply "${method[@]}" -radius 1.575 -sharp 0,1,0,0.0425 # half way up
  reconstruct "$points" venus_50.ply "${method[@]}" -radius 2.625
  reconstruct "$points" venus_100.ply "${method[@]}" -radius 5.25
  draw figure5.png --columns 6 --width 250 --height 440 --from=0.5,0.1,1 --up=0,1,0 \
    "(a) 711 points=$points" "(b) 10 %=venus_10.ply" "(c) 30 %=venus_30.ply" \
    "(d) 30 %, sharp half way up=venus_30_sharp.ply" "(e) 50 %=venus_50.ply" "(f) 100 %=venus_100.ply"
}

# ---- Figure 6: a constant support, and one that widens from the top to the bottom; the box's largest side is 1.9765 --

figure6()
{
  local points="$data/happy_buddha_5000.xyz"
  local constant=(-radius 0.0988 -resolution 120) ramp=(-radius_ramp "y,1.9765,0.0988" -resolution 80)
  reconstruct "$points" buddha_constant.ply "${papers_method[@]}" "${constant[@]}"
  reconstruct "$points" buddha_ramp.ply "${papers_method[@]}" "${ramp[@]}"
  reconstruct "$points" buddha_hermite_constant.ply "${constant[@]}"
  reconstruct "$points" buddha_hermite_ramp.ply "${ramp[@]}"
  draw figure6.png --columns 5 --width 280 --height 560 --point-size 3 --from=0,0,1 --up=0,1,0 \
    "(a) 5000 points=$points" "(b) 5 %=buddha_constant.ply" "(c) 5 % to 100 %=buddha_ramp.ply" \
    "(b) Hermite=buddha_hermite_constant.ply" "(c) Hermite=buddha_hermite_ramp.ply"
}

figure2
if have 3 screwdriver_40722.xyz; then figure3; fi
if have 5 venus_711.off; then figure5; fi
if have 6 happy_buddha_5000.xyz; then figure6; fi
