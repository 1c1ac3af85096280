/*
 * raycast.h: pictures of the inside of a mesh of dimension 3: of the values along rays from the eye
 * through each pixel.
 */
#ifndef ABACUS_ABACUS_RAYCAST_H
#define ABACUS_ABACUS_RAYCAST_H

#include "abacus/draw.h"

#ifdef __cplusplus
extern "C" {
#endif

/* How a pixel shows the values along its ray. */
typedef enum abacus_ray_mode
{
	ABACUS_RAY_MEAN = 0, /* over the length inside the mesh */
	ABACUS_RAY_MAX,
	ABACUS_RAY_MIN,
	ABACUS_RAY_SUM       /* the integral along the ray */
} abacus_ray_mode;

/* For what is not given (has_… is 0), see abacus_draw_volume(). */
typedef struct abacus_camera
{
	int32_t has_eye, has_toward, has_up;
	double eye[3], toward[3], up[3];
	double field_of_view; /* degrees from the bottom of the picture to its top, below 180; 0: rays
							 are parallel */
	abacus_ray_mode mode;
} abacus_camera;

/*
 * Draws a mesh of dimension 3 as a PNG. The drawing's box is the part of the mesh that rays see;
 * empty: all of it. Edges and exaggeration have no effect. Without an attribute the picture shows
 * the length of rays inside the mesh.
 *
 * Unless something else is given, the eye looks toward the middle of the box, from the south-west
 * and above, and z points up, or y if the eye looks straight up or down. Parallel rays show all of
 * the box: it just fits into the picture, whatever the distance of the eye.
 */
ABACUS_API abacus_status abacus_draw_volume(const abacus_host *host, const abacus_facts *facts,
											const abacus_camera *camera,
											const abacus_drawing *drawing, abacus_picture *picture,
											abacus_error *error);

#ifdef __cplusplus
}
#endif

#endif
