# SPDX-License-Identifier: BSD-3-Clause
#
# The package as its users meet it: installed to a directory of its own, found by another project, built and run.

set(ERKPA_STAGE ${CMAKE_CURRENT_BINARY_DIR}/stage)

# Adds a test that configures, builds and runs the project of a user against what was installed.
# erkpa_add_consumer_test(<name> <cmake option>...)
function(erkpa_add_consumer_test name)
  add_test(NAME package.${name} COMMAND ${CMAKE_CTEST_COMMAND}
    --build-and-test ${CMAKE_CURRENT_SOURCE_DIR}/consumer ${CMAKE_CURRENT_BINARY_DIR}/package/${name}
    --build-generator ${CMAKE_GENERATOR}
    --build-options -DCMAKE_CXX_COMPILER=${CMAKE_CXX_COMPILER} -DCMAKE_PREFIX_PATH=${ERKPA_STAGE} ${ARGN}
    --test-command consumer)
  set_tests_properties(package.${name} PROPERTIES
    TIMEOUT 2400 SKIP_REGULAR_EXPRESSION "consumer: skipped" FIXTURES_REQUIRED stage)
endfunction()

add_test(NAME package.install
  COMMAND ${CMAKE_COMMAND} --install ${PROJECT_BINARY_DIR} --config $<CONFIG> --prefix ${ERKPA_STAGE})
set_tests_properties(package.install PROPERTIES FIXTURES_SETUP stage)

if(BUILD_SHARED_LIBS)
  erkpa_add_consumer_test(consumer -DCMAKE_BUILD_TYPE=Release)
  erkpa_add_consumer_test(consumer_avx2 -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_FLAGS=-mavx2)
  add_test(NAME package.consumer_pkg_config
    COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/consumer/pkg_config.sh ${ERKPA_STAGE}/${CMAKE_INSTALL_LIBDIR}/pkgconfig
            ${CMAKE_CURRENT_BINARY_DIR}/package/pkg_config ${CMAKE_CXX_COMPILER})
  set_tests_properties(package.consumer_pkg_config PROPERTIES TIMEOUT 2400 FIXTURES_REQUIRED stage)
else()
  # A static library has no linker map to protect it: there all code must be built with the same flags as PCL, as is
  # the rule with Eigen.
  erkpa_add_consumer_test(consumer_static
    -DCMAKE_BUILD_TYPE=${CMAKE_BUILD_TYPE} "-DCMAKE_CXX_FLAGS=${CMAKE_CXX_FLAGS}")
endif()

# add_subdirectory and FetchContent; the compiler has seen these sources, so configuring will do.
add_test(NAME package.subproject
  COMMAND ${CMAKE_COMMAND} -S ${CMAKE_CURRENT_SOURCE_DIR}/consumer
          -B ${CMAKE_CURRENT_BINARY_DIR}/package/subproject -DERKPA_SOURCE_DIR=${PROJECT_SOURCE_DIR})
