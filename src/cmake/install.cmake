# SPDX-License-Identifier: BSD-3-Clause
#
# What `cmake --install` copies: headers, library, tool, and the files by which CMake, pkg-config and ROS find them.
include(CMakePackageConfigHelpers)

set(ERKPA_INSTALL_CMAKEDIR ${CMAKE_INSTALL_LIBDIR}/cmake/erkpa)

install(TARGETS erkpa EXPORT erkpaTargets
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
  LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}
  RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
if(ERKPA_BUILD_TOOLS)
  install(TARGETS erkpa_reconstruct RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
endif()
install(DIRECTORY include/erkpa ${PROJECT_BINARY_DIR}/include/erkpa
  DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}
  FILES_MATCHING PATTERN "*.h" PATTERN "*.hpp")

# find_package(erkpa)
install(EXPORT erkpaTargets NAMESPACE erkpa:: DESTINATION ${ERKPA_INSTALL_CMAKEDIR})
get_target_property(ERKPA_LIBRARY_TYPE erkpa TYPE)
configure_package_config_file(src/cmake/erkpaConfig.cmake.in ${PROJECT_BINARY_DIR}/erkpaConfig.cmake
  INSTALL_DESTINATION ${ERKPA_INSTALL_CMAKEDIR}
  NO_SET_AND_CHECK_MACRO)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/erkpaConfigVersion.cmake
  COMPATIBILITY SameMinorVersion) # as the SOVERSION
install(FILES ${PROJECT_BINARY_DIR}/erkpaConfig.cmake ${PROJECT_BINARY_DIR}/erkpaConfigVersion.cmake
  DESTINATION ${ERKPA_INSTALL_CMAKEDIR})

# pkg-config erkpa: the paths are relative to the .pc file, so that the installed tree may be moved
file(RELATIVE_PATH ERKPA_PC_PREFIX
  ${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig ${CMAKE_INSTALL_PREFIX})
configure_file(src/cmake/erkpa.pc.in ${PROJECT_BINARY_DIR}/erkpa.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/erkpa.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)

# ROS: the package and the mark by which ament's index lists it
file(TOUCH ${PROJECT_BINARY_DIR}/ament_resource)
install(FILES package.xml DESTINATION share/erkpa)
install(FILES ${PROJECT_BINARY_DIR}/ament_resource DESTINATION share/ament_index/resource_index/packages RENAME erkpa)
