# SPDX-License-Identifier: Apache-2.0
# Every dependency comes from a Debian package; README names each with its reason.
list(APPEND CMAKE_MODULE_PATH "/usr/lib/${CMAKE_LIBRARY_ARCHITECTURE}/cmake/OpenVDB")
find_package(Threads REQUIRED)
find_package(PkgConfig REQUIRED)
# Debian's Imath describes Python libraries it does not ship, and says so at length; errors still show.
set(CMAKE_MESSAGE_LOG_LEVEL WARNING)
find_package(OpenVDB 10.0 REQUIRED COMPONENTS openvdb)
unset(CMAKE_MESSAGE_LOG_LEVEL)
find_package(glm CONFIG REQUIRED)
find_package(fmt CONFIG REQUIRED)
find_package(tomlplusplus CONFIG REQUIRED)
find_package(nlohmann_json CONFIG REQUIRED)
find_package(CLI11 CONFIG REQUIRED)
pkg_check_modules(HWY REQUIRED IMPORTED_TARGET libhwy)
find_package(ZLIB REQUIRED)
find_package(BZip2 REQUIRED)
pkg_check_modules(ZIP REQUIRED IMPORTED_TARGET libzip)
pkg_check_modules(HDF5 REQUIRED IMPORTED_TARGET hdf5-serial)
find_package(OpenGL REQUIRED COMPONENTS OpenGL EGL)
pkg_check_modules(GLFW REQUIRED IMPORTED_TARGET glfw3)
pkg_check_modules(IMGUI REQUIRED IMPORTED_TARGET imgui)
pkg_check_modules(PORTAUDIO REQUIRED IMPORTED_TARGET portaudio-2.0)
pkg_check_modules(JACK REQUIRED IMPORTED_TARGET jack)
pkg_check_modules(PANGOCAIRO REQUIRED IMPORTED_TARGET cairo-pdf pangocairo)
pkg_check_modules(SNDFILE REQUIRED IMPORTED_TARGET sndfile)
pkg_check_modules(SQLITE REQUIRED IMPORTED_TARGET sqlite3)

# Debian's CMake files of GDCM also ask for its Python and VTK parts.
find_path(GDCM_INCLUDE gdcmImageReader.h PATH_SUFFIXES gdcm-3.0 REQUIRED)
add_library(tactus_gdcm INTERFACE)
target_include_directories(tactus_gdcm SYSTEM INTERFACE ${GDCM_INCLUDE})
foreach(part MSFF DSED DICT Common)
  find_library(GDCM_${part} gdcm${part} REQUIRED)
  target_link_libraries(tactus_gdcm INTERFACE ${GDCM_${part}})
endforeach()

find_path(STB_INCLUDE stb/stb_image_write.h REQUIRED)
add_library(tactus_stb INTERFACE)
target_include_directories(tactus_stb SYSTEM INTERFACE ${STB_INCLUDE})

# Its header alone: the library that Debian builds is for float only.
find_path(KISSFFT_INCLUDE kissfft/kissfft.hh REQUIRED)
add_library(tactus_kissfft INTERFACE)
target_include_directories(tactus_kissfft SYSTEM INTERFACE ${KISSFFT_INCLUDE})

add_library(tactus_toml INTERFACE)
target_link_libraries(tactus_toml INTERFACE tomlplusplus::tomlplusplus)
