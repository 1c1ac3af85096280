# The one list of sources: read by Makefile.pgxs (make) and CMakeLists.txt
# (line by line). One file a line.
CORE_SOURCES += src/geometry/predicates.cpp
CORE_SOURCES += src/draw/canvas.cpp
CORE_SOURCES += src/draw/develop.cpp
CORE_SOURCES += src/draw/frame.cpp
CORE_SOURCES += src/draw/palette.cpp
CORE_SOURCES += src/draw/picture.cpp
CORE_SOURCES += src/draw/raster.cpp
CORE_SOURCES += src/draw/relief.cpp
CORE_SOURCES += src/staging/vertex_page.cpp
CORE_SOURCES += src/staging/radix_sort.cpp
CORE_SOURCES += src/staging/curve_sort.cpp
CORE_SOURCES += src/staging/splitters.cpp
CORE_SOURCES += src/staging/external_sort.cpp
CORE_SOURCES += src/staging/stage.cpp
CORE_SOURCES += src/capi/header.cpp
CORE_SOURCES += src/capi/stage.cpp
CORE_SOURCES += src/cache/cache.cpp
CORE_SOURCES += src/cache/cache_place.cpp
CORE_SOURCES += src/cache/cache_load.cpp
CORE_SOURCES += src/cache/cache_evict.cpp
CORE_SOURCES += src/cache/page_format.cpp
CORE_SOURCES += src/cache/probing.cpp
CORE_SOURCES += src/delaunay/insertion.cpp
