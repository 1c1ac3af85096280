/*
 * raster.h: an attribute of a mesh as a raster.
 */
#ifndef ABACUS_ABACUS_RASTER_H
#define ABACUS_ABACUS_RASTER_H

#include "abacus/values.h"

#ifdef __cplusplus
extern "C" {
#endif

/*
 * Pixels between two corners of a window: row 0 has the greatest y. Column i and row j have their
 * centre at lower[0] + (i + 0.5) * (upper[0] - lower[0]) / width and upper[1] - (j + 0.5) *
 * (upper[1] - lower[1]) / height. In space both corners have the same z. With is_geographic the
 * mesh has longitude and latitude, in degrees, and y of the corners and centres are of Web
 * Mercator, in degrees of longitude; the mesh has dimension 2.
 */
typedef struct abacus_raster
{
	double lower[ABACUS_MAX_DIMENSION];
	double upper[ABACUS_MAX_DIMENSION];
	uint32_t width;
	uint32_t height;
	int32_t is_geographic;
} abacus_raster;

/*
 * The values of one attribute at the centres, row by row, as abacus_mesh_interpolate finds them. As
 * many rows as `memory` bytes can hold are filled at once, but at least one.
 */
typedef struct abacus_raster_scan abacus_raster_scan;
ABACUS_API abacus_status abacus_raster_open(const abacus_host *host, const abacus_facts *facts,
											const abacus_raster *raster,
											const abacus_interpolation *interpolation,
											size_t memory, size_t cache_bytes,
											abacus_raster_scan **scan, abacus_error *error);
/* `width` values, valid until the next call; NaN where there is none. */
ABACUS_API abacus_status abacus_raster_next(abacus_raster_scan *scan, const double **values,
											abacus_error *error);
ABACUS_API void abacus_raster_close(abacus_raster_scan *scan);

#ifdef __cplusplus
}
#endif

#endif
