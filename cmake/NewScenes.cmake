# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
# Makes a source file of the program from the scenes that `cayspin new` writes.
function(cayspin_write_new_scenes output)
  set(folder ${PROJECT_SOURCE_DIR}/scenes)
  set(NEW_SCENES "")
  foreach(pair film=film chain=slab_switching crystal=iron bodies=rigid_body_ensemble
               standard_problem=standard_problem_4)
    string(REPLACE "=" ";" pair ${pair})
    list(GET pair 0 kind)
    list(GET pair 1 name)
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${folder}/${name}.toml)
    file(READ ${folder}/${name}.toml text)
    string(APPEND NEW_SCENES
           "    {\"${kind}\", \"scenes/${name}.toml\", R\"toml(${text})toml\"},\n")
  endforeach()
  configure_file(${PROJECT_SOURCE_DIR}/src/program/new_scenes.cpp.in ${output} @ONLY)
endfunction()
