# SPDX-License-Identifier: BSD-3-Clause
#
# The package as its users meet it: installed to a directory of its own, found by another project, built and run.

set(ERKPA_STAGE ${CMAKE_CURRENT_BINARY_DIR}/stage)
set(ERKPA_STATIC_STAGE ${CMAKE_CURRENT_BINARY_DIR}/stage_static)

# Adds a test that configures, builds and runs a project.
# erkpa_add_build_test(<name> <source> <test command> [<cmake option>...])
function(erkpa_add_build_test name source test_command)
  add_test(NAME package.${name} COMMAND ${CMAKE_CTEST_COMMAND}
    --build-and-test ${source} ${CMAKE_CURRENT_BINARY_DIR}/package/${name}
    --build-generator ${CMAKE_GENERATOR}
    --build-options -DCMAKE_CXX_COMPILER=${CMAKE_CXX_COMPILER} -DCMAKE_BUILD_TYPE=Release ${ARGN}
    --test-command ${test_command})
  set_tests_properties(package.${name} PROPERTIES TIMEOUT 2400 SKIP_REGULAR_EXPRESSION "consumer: skipped")
endfunction()

add_test(NAME package.install
  COMMAND ${CMAKE_COMMAND} --install ${PROJECT_BINARY_DIR} --config $<CONFIG> --prefix ${ERKPA_STAGE})
set_tests_properties(package.install PROPERTIES FIXTURES_SETUP stage)

erkpa_add_build_test(consumer ${CMAKE_CURRENT_SOURCE_DIR}/consumer consumer
  -DCMAKE_PREFIX_PATH=${ERKPA_STAGE})
erkpa_add_build_test(consumer_avx2 ${CMAKE_CURRENT_SOURCE_DIR}/consumer consumer
  -DCMAKE_PREFIX_PATH=${ERKPA_STAGE} -DCMAKE_CXX_FLAGS=-mavx2)
add_test(NAME package.consumer_pkg_config
  COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/consumer/pkg_config.sh ${ERKPA_STAGE}/${CMAKE_INSTALL_LIBDIR}/pkgconfig
          ${CMAKE_CURRENT_BINARY_DIR}/package/pkg_config ${CMAKE_CXX_COMPILER})
set_tests_properties(package.consumer_pkg_config PROPERTIES TIMEOUT 2400)
set_tests_properties(package.consumer package.consumer_avx2 package.consumer_pkg_config
  PROPERTIES FIXTURES_REQUIRED stage)

# A static library has no linker map to protect it: there all code must be built with the same flags as PCL, as is the
# rule with Eigen.
erkpa_add_build_test(static_library ${PROJECT_SOURCE_DIR} "${CMAKE_COMMAND};--install;."
  -DBUILD_SHARED_LIBS=OFF -DERKPA_BUILD_TOOLS=OFF -DERKPA_BUILD_SAMPLES=OFF -DERKPA_BUILD_TESTS=OFF
  -DCMAKE_BUILD_TYPE=None -DCMAKE_CXX_FLAGS=-O0 -DERKPA_PRECOMPILE_HEADERS=ON
  -DCMAKE_INSTALL_PREFIX=${ERKPA_STATIC_STAGE})
set_tests_properties(package.static_library PROPERTIES
  FIXTURES_SETUP static_stage PROCESSORS 2 ENVIRONMENT CMAKE_BUILD_PARALLEL_LEVEL=2)
erkpa_add_build_test(consumer_static ${CMAKE_CURRENT_SOURCE_DIR}/consumer consumer
  -DCMAKE_PREFIX_PATH=${ERKPA_STATIC_STAGE})
set_tests_properties(package.consumer_static PROPERTIES FIXTURES_REQUIRED static_stage)

# add_subdirectory and FetchContent; the compiler has seen these sources, so configuring will do.
add_test(NAME package.subproject
  COMMAND ${CMAKE_COMMAND} -S ${CMAKE_CURRENT_SOURCE_DIR}/consumer
          -B ${CMAKE_CURRENT_BINARY_DIR}/package/subproject -DERKPA_SOURCE_DIR=${PROJECT_SOURCE_DIR})
