# Completion in bash and, where help2man is there, manual pages: both made of what the programs say of themselves.
find_program(HELP2MAN help2man)
set(manual ${PROJECT_BINARY_DIR}/package/man1)
set(pages)
foreach(program tss tss-render)
    if(NOT TARGET ${program})
        continue()
    endif()
    install(FILES ${CMAKE_CURRENT_LIST_DIR}/completion.bash
            DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME ${program})
    if(HELP2MAN AND NOT OSGTSS_SANITIZE)
        add_custom_command(OUTPUT ${manual}/${program}.1.gz
                           COMMAND bash ${CMAKE_CURRENT_LIST_DIR}/manual.sh $<TARGET_FILE:${program}> ${manual} ${PROJECT_VERSION}
                           DEPENDS ${program} ${CMAKE_CURRENT_LIST_DIR}/manual.sh VERBATIM)
        list(APPEND pages ${manual}/${program}.1.gz)
    endif()
endforeach()
if(pages)
    add_custom_target(manual ALL DEPENDS ${pages})
    install(DIRECTORY ${manual} DESTINATION ${CMAKE_INSTALL_MANDIR} FILES_MATCHING PATTERN "*.1.gz")
endif()
