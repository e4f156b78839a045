# Where the installed libraries stand, and how other projects find them: headers, libraries, plugins in the folder that
# OSG looks into, a CMake package and pkg-config files. Everything finds its neighbours by relative paths, so that a
# prefix may be moved, and needs no environment variable below /usr and /usr/local. Without the node kit, the core alone.
include(CMakePackageConfigHelpers)

set(OSGTSS_CORE_INCLUDES ${CMAKE_INSTALL_INCLUDEDIR}/tss) # the headers of bake/, named "bake/..." in there too
set(OSGTSS_PACKAGE_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/osgTSS)
set(OSGTSS_PLUGIN_DESTINATION ${CMAKE_INSTALL_LIBDIR}/${OSGTSS_PLUGIN_FOLDER})
set(OSGTSS_DOCUMENTS ${CMAKE_INSTALL_DATAROOTDIR}/doc/osgtss) # named like the package, as Debian has it
file(RELATIVE_PATH OSGTSS_PREFIX_FROM_PC /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)

# osgtss_install(<target> <name>): the library, its CMake targets in <name>Targets.cmake, and <name>.pc.
function(osgtss_install target name)
    install(TARGETS ${target} EXPORT ${name}Targets
            LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
            INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
    install(EXPORT ${name}Targets NAMESPACE osgTSS:: DESTINATION ${OSGTSS_PACKAGE_DESTINATION})
    configure_file(${CMAKE_CURRENT_FUNCTION_LIST_DIR}/${name}.pc.in ${PROJECT_BINARY_DIR}/package/${name}.pc @ONLY)
    install(FILES ${PROJECT_BINARY_DIR}/package/${name}.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
endfunction()

osgtss_install(osgTSSCore osgTSSCore)
target_include_directories(osgTSSCore INTERFACE $<INSTALL_INTERFACE:${OSGTSS_CORE_INCLUDES}>)
install(CODE "set(SOURCE \"${PROJECT_SOURCE_DIR}\")
set(INCLUDES \"\${CMAKE_INSTALL_PREFIX}/${OSGTSS_CORE_INCLUDES}\")
include(\"${CMAKE_CURRENT_LIST_DIR}/PublicHeaders.cmake\")")

if(OSGTSS_NODEKIT)
    osgtss_install(osgTSS osgTSS)
    install(TARGETS osgTSSBake EXPORT osgTSSTargets
            LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
            INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
    install(DIRECTORY osgTSS/include/osgTSS DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
    install(DIRECTORY scenes DESTINATION ${CMAKE_INSTALL_DATADIR}/osgTSS FILES_MATCHING PATTERN "*.tss"
            PATTERN extreme EXCLUDE)
endif()
install(FILES LICENSE README.md DESTINATION ${OSGTSS_DOCUMENTS})
install(DIRECTORY docs DESTINATION ${OSGTSS_DOCUMENTS} # where README has them
        FILES_MATCHING PATTERN "*.md" PATTERN "*.png" PATTERN "*.svg")
# What the documents name; doghead alone is of the repository, whose scenes it makes.
install(DIRECTORY examples DESTINATION ${OSGTSS_DOCUMENTS} PATTERN doghead EXCLUDE PATTERN run.sh EXCLUDE)

configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/osgTSSConfig.cmake.in
                              ${PROJECT_BINARY_DIR}/package/osgTSSConfig.cmake
                              INSTALL_DESTINATION ${OSGTSS_PACKAGE_DESTINATION} PATH_VARS OSGTSS_PLUGIN_DESTINATION)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/package/osgTSSConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/package/osgTSSConfig.cmake ${PROJECT_BINARY_DIR}/package/osgTSSConfigVersion.cmake
        DESTINATION ${OSGTSS_PACKAGE_DESTINATION})

# What an install put where: cpack, which installs too, writes CMake's own list anew.
install(CODE "
    if(NOT \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}\" MATCHES \"/_CPack_Packages/\")
        list(JOIN CMAKE_INSTALL_MANIFEST_FILES \"\\n\" files)
        file(WRITE \"${PROJECT_BINARY_DIR}/package/installed.txt\" \"\${files}\\n\")
    endif()")
if(NOT TARGET uninstall) # a project around this one may have its own
    add_custom_target(uninstall VERBATIM
        COMMAND ${CMAKE_COMMAND} -D BINARY_DIR=${PROJECT_BINARY_DIR} -P ${CMAKE_CURRENT_LIST_DIR}/uninstall.cmake
        COMMENT "Removing what was installed")
endif()
