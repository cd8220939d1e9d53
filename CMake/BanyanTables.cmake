# SPDX-License-Identifier: BSD-3-Clause
# Makes ParaView's XML of tables that are macros of C++: a row is Kind(word, word, ..., "sentence").
# A table that changes is read again by the next build.

# Calls `handle(Kind "word;word;..." sentence)` for each row of the macro in the header.
function(banyan_read_table header macro handle)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${header}")
  file(READ "${header}" text)
  if(NOT text MATCHES "#define ${macro}\\([A-Za-z, ]+\\)((\\\\\n|[^\n\\]|\\\\[^\n])*)\n")
    message(FATAL_ERROR "${header} has no table ${macro}.")
  endif()
  string(REGEX REPLACE "[ \\\n]*\\\\\n[ ]*" " " rows "${CMAKE_MATCH_1}")
  set(literal "\"[^\"]*\"")
  while(rows MATCHES "^ *([A-Z][A-Za-z]*)\\(([^\"()]*), *(${literal}( ${literal})*)\\)")
    string(LENGTH "${CMAKE_MATCH_0}" length)
    set(kind "${CMAKE_MATCH_1}")
    set(words "${CMAKE_MATCH_2}")
    set(sentence "${CMAKE_MATCH_3}")
    string(REGEX REPLACE ", *" ";" words "${words}")
    string(REGEX REPLACE "\" \"|^\"|\"$" "" sentence "${sentence}")
    foreach(pair IN ITEMS "&=amp" "<=lt" ">=gt")
      string(REGEX REPLACE "=.*" "" sign "${pair}")
      string(REGEX REPLACE ".*=" "" entity "${pair}")
      string(REPLACE "${sign}" "&${entity};" sentence "${sentence}")
    endforeach()
    cmake_language(CALL ${handle} "${kind}" "${words}" "${sentence}")
    string(SUBSTRING "${rows}" ${length} -1 rows)
  endwhile()
  if(NOT rows MATCHES "^ *$")
    string(SUBSTRING "${rows}" 0 120 start)
    message(FATAL_ERROR "${header}: a row of ${macro} is not Kind(word, ..., \"sentence without "
      "quotation marks\"). It begins: ${start}")
  endif()
endfunction()

# Stops unless a row has as many words before its sentence as rows of its kind have.
function(banyan_check_words kind words)
  cmake_parse_arguments(PARSE_ARGV 2 count "" "Number;Text;Real;Whole;Switch;Choice" "")
  list(LENGTH words length)
  if(NOT DEFINED count_${kind})
    message(FATAL_ERROR "A row begins with ${kind}(${words}): this table has no such kind.")
  endif()
  if(NOT length EQUAL "${count_${kind}}")
    message(FATAL_ERROR "The row ${kind}(${words}) has ${length} words before its sentence, not "
      "${count_${kind}}: see the comment above the table.")
  endif()
endfunction()

# Collects the XML of one statistic.
function(banyan_add_statistic kind words sentence)
  banyan_check_words(${kind} "${words}" Number 4 Text 2)
  list(POP_BACK words where)
  if(kind STREQUAL "Text")
    list(PREPEND words "text")
  endif()
  list(GET words 0 type)
  list(GET words 1 name)
  set(xml_of_double Double)
  set(xml_of_vtkIdType IdType)
  set(xml_of_text String)
  if(NOT DEFINED xml_of_${type})
    message(FATAL_ERROR "The statistic ${name} has the type ${type}: ParaView's XML is made of "
      "double, vtkIdType and Text.")
  endif()
  set(xml "${xml_of_${type}}")
  set_property(GLOBAL APPEND_STRING PROPERTY BANYAN_STATISTICS
"      <${xml}VectorProperty name=\"${name}\" command=\"Get${name}\" information_only=\"1\">
        <Simple${xml}InformationHelper />
        <Documentation>${sentence}</Documentation>
      </${xml}VectorProperty>\n")
  set_property(GLOBAL APPEND_STRING PROPERTY BANYAN_EXPOSED_STATISTICS
"          <Property name=\"${name}\" />\n")
  if(where STREQUAL "panel")
    set_property(GLOBAL APPEND_STRING PROPERTY BANYAN_STATISTICS_ON_PANEL
"            <Property name=\"${name}\" panel_visibility=\"default\" />\n")
  elseif(where STREQUAL "script")
    set_property(GLOBAL APPEND_STRING PROPERTY BANYAN_STATISTICS_ON_NO_PANEL
"          <Property name=\"${name}\" panel_visibility=\"never\" />\n")
  else()
    message(FATAL_ERROR "The statistic ${name} is for \"${where}\": say panel or script.")
  endif()
endfunction()

# Collects the XML of one setting, and its lines on the panels.
function(banyan_add_setting kind words sentence)
  banyan_check_words(${kind} "${words}" Real 8 Whole 7 Switch 4 Choice 6)
  list(POP_BACK words data)
  list(POP_BACK words panel)
  list(GET words 0 name)
  set(visibility "")
  if(panel STREQUAL "advanced")
    set(visibility " panel_visibility=\"advanced\"")
  elseif(NOT panel STREQUAL "default")
    message(FATAL_ERROR "The setting ${name} is \"${panel}\" on the panel: say default or advanced.")
  endif()
  set(panels_of_all IMAGES MESHES LEAVES)
  set(panels_of_images IMAGES)
  set(panels_of_cells MESHES LEAVES)
  set(panels_of_meshes MESHES)
  if(NOT DEFINED panels_of_${data})
    message(FATAL_ERROR "The setting ${name} is for \"${data}\": say all, images, cells or meshes.")
  endif()
  foreach(kind_of_data IN LISTS panels_of_${data})
    set_property(GLOBAL APPEND_STRING PROPERTY BANYAN_SETTINGS_OF_${kind_of_data}
"            <Property name=\"${name}\" panel_visibility=\"${panel}\" />\n")
  endforeach()
  if(kind STREQUAL "Choice")
    return()
  endif()
  if(kind STREQUAL "Switch")
    list(GET words 1 default)
    string(REPLACE "true" "1" default "${default}")
    string(REPLACE "false" "0" default "${default}")
    set(type Int)
    set(domain "<BooleanDomain name=\"bool\" />")
  else()
    list(GET words 2 default)
    list(GET words 3 least)
    list(GET words -1 most)
    set(type Int)
    if(kind STREQUAL "Real")
      set(type Double)
    endif()
    set(domain "<${type}RangeDomain name=\"range\" min=\"${least}\" max=\"${most}\" />")
  endif()
  set(label "")
  if(words MATCHES ";1/255;")
    # Names in Python are labels without all that is no ASCII letter or digit: no-break spaces keep
    # a label on two lines, and the unit is written in superscripts, so that names stay.
    string(REGEX REPLACE "([a-z])([A-Z])" "\\1 \\2" label "${name}")
    string(REPLACE "Image Error" "Image&#160;Error" label "${label}")
    set(label " label=\"${label}&#160;(&#185;&#8260;&#8322;&#8325;&#8325;)\"")
  endif()
  set_property(GLOBAL APPEND_STRING PROPERTY BANYAN_SETTINGS
"      <${type}VectorProperty name=\"${name}\"${label} command=\"Set${name}\"
                            default_values=\"${default}\" number_of_elements=\"1\"${visibility}>
        ${domain}
        <Documentation>${sentence}</Documentation>
      </${type}VectorProperty>\n")
endfunction()

# Writes `folder`/`name`.xml for each `name`.xml.in, with the rows of the tables in place.
function(banyan_configure_xml folder)
  banyan_read_table("${Banyan_SOURCE_DIR}/Rendering/vtkBanyanFrameStatistics.h"
    BANYAN_FRAME_STATISTICS banyan_add_statistic)
  banyan_read_table("${Banyan_SOURCE_DIR}/Rendering/vtkBanyanVolumeMapper.h"
    BANYAN_VOLUME_SETTINGS banyan_add_setting)
  foreach(part IN ITEMS SETTINGS SETTINGS_OF_IMAGES SETTINGS_OF_MESHES SETTINGS_OF_LEAVES
      STATISTICS EXPOSED_STATISTICS STATISTICS_ON_PANEL STATISTICS_ON_NO_PANEL)
    get_property(BANYAN_${part} GLOBAL PROPERTY BANYAN_${part})
  endforeach()
  foreach(name IN LISTS ARGN)
    configure_file("${Banyan_SOURCE_DIR}/Representations/${name}.xml.in" "${folder}/${name}.xml"
      @ONLY)
  endforeach()
endfunction()
