# Where an installed kit stands, and how other projects find it: headers, library, plugins in the folder that OSG looks
# into, a CMake package and a pkg-config file. Everything finds its neighbours by relative paths, so that a prefix may be
# moved, and needs no environment variable below /usr and /usr/local.
include(CMakePackageConfigHelpers)

set(OSGTSS_PLUGIN_DESTINATION ${CMAKE_INSTALL_LIBDIR}/${OSGTSS_PLUGIN_FOLDER})
set(OSGTSS_CORE_INCLUDES ${CMAKE_INSTALL_INCLUDEDIR}/tss) # the headers of bake/, named "bake/..." in there too
set(OSGTSS_PACKAGE_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/osgTSS)

install(TARGETS osgTSS EXPORT osgTSSTargets
        LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
target_include_directories(osgTSS INTERFACE $<INSTALL_INTERFACE:${OSGTSS_CORE_INCLUDES}>)

install(DIRECTORY include/osgTSS DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
# Of the core what the library holds.
install(FILES ${PROJECT_SOURCE_DIR}/bake/JointPlan.h ${PROJECT_SOURCE_DIR}/bake/SkinSetup.h
        DESTINATION ${OSGTSS_CORE_INCLUDES}/bake)
install(FILES ${PROJECT_SOURCE_DIR}/bake/geometry/TriangleMesh.h DESTINATION ${OSGTSS_CORE_INCLUDES}/bake/geometry)
install(FILES ${PROJECT_SOURCE_DIR}/bake/spheres/SphereSet.h DESTINATION ${OSGTSS_CORE_INCLUDES}/bake/spheres)
foreach(folder base motion table respond scene)
    install(DIRECTORY ${PROJECT_SOURCE_DIR}/bake/${folder} DESTINATION ${OSGTSS_CORE_INCLUDES}/bake
            FILES_MATCHING PATTERN "*.h")
endforeach()

install(EXPORT osgTSSTargets NAMESPACE osgTSS:: DESTINATION ${OSGTSS_PACKAGE_DESTINATION})
configure_package_config_file(osgTSSConfig.cmake.in ${CMAKE_CURRENT_BINARY_DIR}/osgTSSConfig.cmake
                              INSTALL_DESTINATION ${OSGTSS_PACKAGE_DESTINATION} PATH_VARS OSGTSS_PLUGIN_DESTINATION)
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/osgTSSConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/osgTSSConfig.cmake ${CMAKE_CURRENT_BINARY_DIR}/osgTSSConfigVersion.cmake
        DESTINATION ${OSGTSS_PACKAGE_DESTINATION})

file(RELATIVE_PATH OSGTSS_PREFIX_FROM_PC /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
configure_file(osgTSS.pc.in ${CMAKE_CURRENT_BINARY_DIR}/osgTSS.pc @ONLY)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/osgTSS.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
