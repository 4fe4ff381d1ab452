# Writes OUTPUT, a header with a digest of every C++ source below ROOT/cpp and of FLAGS: it tells cached truths apart from those
# that repaired code would make. Called by the build whenever a source changes.
file(GLOB_RECURSE sources RELATIVE ${ROOT} ${ROOT}/cpp/*.h ${ROOT}/cpp/*.cpp)
list(SORT sources)
set(all "${FLAGS}")
foreach(source IN LISTS sources)
  file(SHA256 ${ROOT}/${source} hash)
  string(APPEND all "${source} ${hash}\n")
endforeach()
string(SHA256 digest "${all}")
file(WRITE ${OUTPUT} "#define INTERREFLECT_SOURCES \"${digest}\"\n")
