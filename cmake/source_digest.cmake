cmake_minimum_required(VERSION 3.25)
# Writes OUT, a header with a digest of FILES and of FLAGS: what decides what the cycle computes. Two builds with the same
# digest and the same compiler give the same results, bit for bit. Touches OUT only when the digest changes.
separate_arguments(FILES)
list(SORT FILES)
set(all "${FLAGS}")
foreach(file ${FILES})
  file(SHA256 ${ROOT}/${file} digest)
  string(APPEND all "\n${file} ${digest}")
endforeach()
string(SHA256 digest "${all}")
string(SUBSTRING ${digest} 0 12 digest)
file(CONFIGURE OUTPUT ${OUT} CONTENT "#pragma once\n#define CONTOUR_SOURCE_DIGEST \"@digest@\"\n" @ONLY)
