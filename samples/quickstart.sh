#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
#
# From nothing to meshes (Debian, Ubuntu): installs what is needed, builds erkpa_reconstruct and reconstructs two real
# point sets of Debian's libcgal-demo into build/quickstart.
set -euo pipefail

repo=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
out="$repo/build/quickstart"
archive=/usr/share/doc/libcgal-dev/data.tar.gz

"$repo/src/cmake/apt_install.sh" g++ make cmake pkg-config \
  libpcl-dev libeigen3-dev libboost-program-options-dev nlohmann-json3-dev libxsimd-dev libcgal-demo pcl-tools

cmake -S "$repo" -B "$out/build" -DERKPA_BUILD_SAMPLES=OFF -DERKPA_BUILD_TESTS=OFF --log-level=WARNING
cmake --build "$out/build" --parallel "$("$repo/src/cmake/build_jobs.sh")"
tar -xzf "$archive" -C "$out" --strip-components=2 data/points_3/kitten.xyz data/points_3/ball.ply

reconstruct()
{
  echo "> erkpa_reconstruct $*"
  (cd "$out" && build/erkpa_reconstruct "$@")
}

# Points with normals, and nothing else to say.
reconstruct kitten.xyz kitten_mesh.ply
reconstruct kitten.xyz kitten_mesh.vtk

# A scanned ball of twenty flat faces. A wide support evens out the noise of the scan, and the edges with it ...
wide=(-k 200 -resolution 100)
reconstruct ball.ply ball_round.vtk "${wide[@]}"

# ... unless it is told where they are: fifteen planes through opposite edges, each halfway between two faces.
# shellcheck disable=SC2054 # the commas are meant
planes=(
  -0.3520,-0.9327,0.0788,-32.747 0.7581,-0.0163,-0.6520,-30.695 0.5435,-0.5854,-0.6016,-51.008
  0.1144,-0.9392,-0.3239,-51.724 0.6841,0.5712,-0.4536,1.652 0.2658,-0.5731,0.7752,-11.785
  0.9451,0.0008,0.3269,-9.517 0.0406,0.5945,0.8031,45.104 -0.6135,-0.3693,-0.6981,-21.810
  0.9177,-0.3595,-0.1694,-37.266 0.7306,-0.5686,0.3780,-29.875 0.3185,0.3432,-0.8836,-12.057
  -0.1901,-0.0212,-0.9815,-21.086 0.2315,-0.9303,0.2845,-38.835 0.7984,0.5825,0.1525,14.686)
sharp=()
for plane in "${planes[@]}"; do
  sharp+=(-sharp "$plane")
done
reconstruct ball.ply ball_sharp.vtk "${wide[@]}" "${sharp[@]}"

cat <<END

Look at the meshes with
  pcl_viewer $out/kitten_mesh.vtk
  pcl_viewer $out/ball_round.vtk
  pcl_viewer $out/ball_sharp.vtk
END
