# SPDX-License-Identifier: BSD-3-Clause
#
# Runs the samples on a cube of side 40, a point every 2 units, written here so that no data is needed.
set(ERKPA_CUBE ${CMAKE_CURRENT_BINARY_DIR}/cube.pcd)
set(points "")
foreach(side -1 1)
  math(EXPR face "20 * ${side}")
  foreach(u RANGE 1 39 2)
    foreach(v RANGE 1 39 2)
      math(EXPR a "${u} - 20")
      math(EXPR b "${v} - 20")
      string(APPEND points
        "${face} ${a} ${b} ${side} 0 0\n" "${a} ${face} ${b} 0 ${side} 0\n" "${a} ${b} ${face} 0 0 ${side}\n")
    endforeach()
  endforeach()
endforeach()
file(WRITE ${ERKPA_CUBE} "# .PCD v0.7
VERSION 0.7
FIELDS x y z normal_x normal_y normal_z
SIZE 4 4 4 4 4 4
TYPE F F F F F F
COUNT 1 1 1 1 1 1
WIDTH 2400
HEIGHT 1
VIEWPOINT 0 0 0 1 0 0 0
POINTS 2400
DATA ascii
${points}")

add_test(NAME sample.replace_poisson COMMAND replace_poisson ${ERKPA_CUBE} replace_poisson.ply)
set_tests_properties(sample.replace_poisson PROPERTIES PASS_REGULAR_EXPRESSION "triangles, 0 boundary edges")

add_test(NAME sample.sharp_edges_from_planes
  COMMAND sharp_edges_from_planes ${ERKPA_CUBE} 6 0.6 sharp_edges_from_planes.ply)
set_tests_properties(sample.sharp_edges_from_planes PROPERTIES PASS_REGULAR_EXPRESSION "12 sharp edges, 8 corners, [1-9]")

# 1.5 above the middle of the upper face
add_test(NAME sample.evaluate_field
  COMMAND sh -c "echo 0 0 21.5 | \"$1\" \"$2\"" sh $<TARGET_FILE:evaluate_field> ${ERKPA_CUBE})
set_tests_properties(sample.evaluate_field PROPERTIES PASS_REGULAR_EXPRESSION "f = 1\\.(5|4999|5000)")

set_tests_properties(sample.replace_poisson sample.sharp_edges_from_planes sample.evaluate_field
  PROPERTIES TIMEOUT 300)
