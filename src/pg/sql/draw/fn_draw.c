/*
 * fn_draw.c: abacus_draw, abacus_draw_section and abacus_draw_volume, pictures of a mesh as PNG.
 * The first two also draw octrees.
 */
#include "postgres.h"

#include <math.h>

#include "mb/pg_wchar.h"
#include "utils/builtins.h"
#include "utils/lsyscache.h"
#include "utils/memutils.h"

#include "abacus/raycast.h"
#include "pg/base/settings.h"
#include "pg/base/sql_function.h"
#include "pg/mesh/reader.h"
#include "pg/mesh/shape.h"
#include "pg/sql/arguments/extent_arguments.h"
#include "pg/sql/arguments/level_argument.h"
#include "pg/sql/arguments/step_argument.h"
#include "pg/sql/arguments/units.h"
#include "pg/sql/arguments/word.h"
#include "pg/sql/draw/drawing.h"

SQL_FUNCTION(abacus_sql_draw);
SQL_FUNCTION(abacus_sql_draw_section);
SQL_FUNCTION(abacus_sql_draw_volume);

/* Arguments of both, in order */
enum
{
	STYLE_RAMP,
	STYLE_CONTOURS,
	STYLE_LEGEND,
	STYLE_SCALE_BAR,
	STYLE_TRANSPARENT,
	STYLE_ARGUMENTS
};

/* Arguments of abacus_draw */
enum
{
	DRAW_MESH,
	DRAW_WIDTH,
	DRAW_HEIGHT,
	DRAW_LOWER,
	DRAW_UPPER,
	DRAW_ATTRIBUTE,
	DRAW_EDGES,
	DRAW_EXAGGERATION,
	DRAW_MAX_EDGE,
	DRAW_RANGE,
	DRAW_STYLE,
	DRAW_LIGHT = DRAW_STYLE + STYLE_ARGUMENTS,
	DRAW_WITHIN,
	DRAW_REGIONS,
	DRAW_LINES,
	DRAW_MAX_ERROR,
	DRAW_CONTOUR_LABELS,
	DRAW_STEP
};

/* Arguments of abacus_draw_section */
enum
{
	SECTION_MESH,
	SECTION_THROUGH,
	SECTION_NORMAL,
	SECTION_WIDTH,
	SECTION_HEIGHT,
	SECTION_ATTRIBUTE,
	SECTION_EDGES,
	SECTION_LOWER,
	SECTION_UPPER,
	SECTION_EXAGGERATION,
	SECTION_MAX_EDGE,
	SECTION_RANGE,
	SECTION_STYLE,
	SECTION_STEP = SECTION_STYLE + STYLE_ARGUMENTS
};

static ArrayType *
array(FunctionCallInfo fcinfo, int argument)
{
	return PG_ARGISNULL(argument) ? NULL : PG_GETARG_ARRAYTYPE_P(argument);
}

/* The window, by the same rules as the domain of a new mesh; empty if not given. */
static void
window(const abacus_form *mesh, ArrayType *lower, ArrayType *upper, abacus_drawing *drawing)
{
	abacus_form shape = {0};

	shape.dimension = mesh->dimension;
	shape_domain(&shape, lower, upper);
	memcpy(drawing->lower, shape.lower, sizeof(drawing->lower));
	memcpy(drawing->upper, shape.upper, sizeof(drawing->upper));
}

/* A text in the core's encoding; NULL if not given. */
static const char *
caption(FunctionCallInfo fcinfo, int argument)
{
	char	   *given;

	if (PG_ARGISNULL(argument))
		return NULL;
	given = text_to_cstring(PG_GETARG_TEXT_PP(argument));
	return pg_server_to_any(given, (int) strlen(given), PG_UTF8);
}

/* Colours, lines and captions: the arguments from `first` on. */
static void
style(FunctionCallInfo fcinfo, int first, abacus_drawing *drawing)
{
	drawing_ramp(fcinfo, first + STYLE_RAMP, drawing);
	drawing_contours(fcinfo, first + STYLE_CONTOURS, drawing);
	if (drawing_is_given(fcinfo, first + STYLE_LEGEND, "legend", drawing))
		drawing->legend = caption(fcinfo, first + STYLE_LEGEND);
	drawing->scale_bar = caption(fcinfo, first + STYLE_SCALE_BAR);
	drawing->transparent = drawing_flag(fcinfo, first + STYLE_TRANSPARENT);
}

/* The direction of the light, if given. */
static void
light(FunctionCallInfo fcinfo, int argument, abacus_drawing *drawing)
{
	if (PG_ARGISNULL(argument))
		return;
	shape_pair(PG_GETARG_ARRAYTYPE_P(argument), "light", drawing->light);
	if (!isfinite(drawing->light[0]) || !(drawing->light[1] > 0 && drawing->light[1] <= 90))
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
				 errmsg("light must be a direction in degrees, and an altitude above 0 and at most 90"),
				 errhint("The direction is counted clockwise from north: {315,45} is in the north-west, halfway up.")));
	if (drawing->attribute < 0 || drawing->exaggeration == 0)
		ereport(NOTICE, (errmsg("light has no effect without exaggeration")));
}

/* Regions and fixed edges; a notice if there are none. An octree has none. */
static void
overlay(FunctionCallInfo fcinfo, const abacus_census *census, abacus_drawing *drawing)
{
	drawing_overlay(fcinfo, DRAW_REGIONS, DRAW_LINES, drawing);
	if (drawing->regions && census->regions == 0)
		ereport(NOTICE, (errmsg("regions has no effect without regions")));
	if (drawing->lines && census->lines == 0)
		ereport(NOTICE, (errmsg("lines has no effect without lines")));
}

/* Opens a mesh or an octree for drawing. */
static Reader *
open_drawn(Oid drawn)
{
	return reader_open_of(drawn, ANY_TYPE, CurrentMemoryContext);
}

/*
 * The number of an attribute by its name, or, counted after the attributes, of a label; -1 if not
 * given, unless a step is.
 */
static int
attribute_or_label(FunctionCallInfo fcinfo, int argument, int step, abacus_names names)
{
	if (!PG_ARGISNULL(argument))
	{
		const char *name = text_to_cstring(PG_GETARG_TEXT_PP(argument));
		int			label = header_label(names, name);

		if (label >= 0)
			return (int) names.facts->columns.attributes + label;
		if (names.facts->columns.labels > 0 && header_attribute(names, name) < 0)
			ereport(ERROR,
					(errcode(ERRCODE_UNDEFINED_COLUMN),
					 errmsg("mesh has no attribute or label \"%s\"", name)));
	}
	return step_or_attribute(fcinfo, step, argument, names);
}

/*
 * Contours are lines through changing values. A leaf of an octree has only one value, and a simplex
 * has one value for each label.
 */
static void
leave_contours_out(const abacus_facts *facts, abacus_drawing *drawing)
{
	bool		is_octree = facts->form.type == ABACUS_OCTREE;

	if (drawing->contour_interval == 0 ||
		!(is_octree || drawing->attribute >= (int) facts->columns.attributes))
		return;
	drawing->contour_interval = 0;
	ereport(NOTICE, (errmsg("contours has no effect on %s", is_octree ? "an octree" : "a label")));
}

/* Values on contours; a notice if there are none. */
static void
contour_labels(FunctionCallInfo fcinfo, abacus_drawing *drawing)
{
	drawing->contour_labels = drawing_flag(fcinfo, DRAW_CONTOUR_LABELS);
	drawing->memory = setting_query_sort_bytes() + setting_cache_bytes();
	if (drawing->contour_labels && drawing->contour_interval == 0)
		ereport(NOTICE, (errmsg("contour_labels has no effect without contours")));
}

/* Reports why a picture shows nothing; `place` is where nothing is. */
static void
tell_blank(const Reader *reader, const abacus_drawing *drawing, const char *cells,
		   const char *place)
{
	const abacus_facts *facts = &reader->header.facts;
	uint64		waiting = facts->census.staged - facts->census.inserted;
	bool		is_octree = facts->form.type == ABACUS_OCTREE;
	bool		has_cells = is_octree || facts->census.simplices > 0;

	if (is_octree)
		cells = "leaves";
	ereport(NOTICE,
			(errmsg("the picture of %s \"%s\" is blank", is_octree ? "octree" : "mesh",
					get_rel_name(mesh_pages(reader->host)->mesh)),
			 has_cells ? errdetail("None of its %s is %s.", cells, place) :
			 waiting == 0 ? errdetail("It has no %s.", cells) :
			 errdetail("It has no %s. %llu points wait: they are only staged, or span none.", cells,
					   (unsigned long long) waiting),
			 has_cells && drawing->extent.max_edge > 0 ?
			 errhint("Increase max_edge: %s with a longer edge are left out.", cells) : 0));
}

/*
 * abacus_draw(mesh regclass, width int, height int, lower float8[],
 * upper float8[], attribute text, edges boolean, exaggeration float8,
 * max_edge float8, range float8[], ramp text, contours float8, legend text,
 * scale_bar text, transparent boolean, light float8[], within text,
 * regions boolean, lines boolean, max_error float8, contour_labels boolean,
 * step int8) -> bytea
 */
Datum
abacus_sql_draw(PG_FUNCTION_ARGS)
{
	static const LevelArguments level = {
		.mesh = DRAW_MESH,.attribute = DRAW_ATTRIBUTE,.within = DRAW_WITHIN,.regions = DRAW_REGIONS,
		.step = DRAW_STEP,.max_error = DRAW_MAX_ERROR,.pixel_error = -1
	};
	Oid			mesh;
	Reader	   *reader;
	Host	   *host;
	abacus_drawing drawing = {0};
	abacus_picture picture = {0};

	if (PG_ARGISNULL(DRAW_MESH))
		PG_RETURN_NULL();
	mesh = level_argument(fcinfo, &level);
	reader = open_drawn(mesh);
	host = reader->host;
	header_require_dimension(&reader->header.facts.form, 2, "Use abacus_draw_section for a cut through it.");
	step_argument(fcinfo, DRAW_STEP, reader);
	drawing.width = drawing_pixels(fcinfo, DRAW_WIDTH, 1024, "width");
	drawing.height = drawing_pixels(fcinfo, DRAW_HEIGHT, 0, "height");
	drawing.attribute = attribute_or_label(fcinfo, DRAW_ATTRIBUTE, DRAW_STEP, abacus_names_of(&reader->header));
	drawing.edges = PG_ARGISNULL(DRAW_EDGES) || PG_GETARG_BOOL(DRAW_EDGES);
	drawing.exaggeration = drawing_factor(fcinfo, DRAW_EXAGGERATION, "exaggeration");
	extent_arguments(fcinfo, DRAW_MAX_EDGE, DRAW_WITHIN, mesh, &reader->header, reader->host,
					 &drawing.extent);
	drawing_range(fcinfo, DRAW_RANGE, &drawing);
	style(fcinfo, DRAW_STYLE, &drawing);
	leave_contours_out(&reader->header.facts, &drawing);
	contour_labels(fcinfo, &drawing);
	light(fcinfo, DRAW_LIGHT, &drawing);
	overlay(fcinfo, &reader->header.facts.census, &drawing);
	if (drawing.exaggeration > 0 && drawing.attribute < 0)
		ereport(NOTICE, (errmsg("exaggeration has no effect without an attribute")));
	else if (drawing.exaggeration > 0)
		units_tell_shading(&reader->header.facts.form, drawing.exaggeration);
	window(&reader->header.facts.form, array(fcinfo, DRAW_LOWER), array(fcinfo, DRAW_UPPER), &drawing);

	host_run(host, abacus_draw, &host->table, &reader->header.facts, &drawing, &picture);
	if (picture.is_blank)
		tell_blank(reader, &drawing, "triangles", "in the window");
	PG_RETURN_BYTEA_P(drawing_finish(host, &picture));
}

/*
 * abacus_draw_section(mesh regclass, through float8[], normal float8[],
 * width int, height int, attribute text, edges boolean, lower float8[],
 * upper float8[], exaggeration float8, max_edge float8, range float8[], ramp text,
 * contours float8, legend text, scale_bar text, transparent boolean, step int8) -> bytea
 */
Datum
abacus_sql_draw_section(PG_FUNCTION_ARGS)
{
	Reader	   *reader;
	Host	   *host;
	abacus_section section;
	abacus_drawing drawing = {0};
	abacus_picture picture = {0};

	if (PG_ARGISNULL(SECTION_MESH) || PG_ARGISNULL(SECTION_THROUGH) ||
		PG_ARGISNULL(SECTION_NORMAL))
		PG_RETURN_NULL();
	reader = open_drawn(PG_GETARG_OID(SECTION_MESH));
	host = reader->host;
	header_require_dimension(&reader->header.facts.form, 3, "Use abacus_draw for a mesh of dimension 2.");
	step_argument(fcinfo, SECTION_STEP, reader);
	shape_point(&reader->header.facts.form, array(fcinfo, SECTION_THROUGH), "through", section.through);
	shape_point(&reader->header.facts.form, array(fcinfo, SECTION_NORMAL), "normal", section.normal);
	section.exaggeration = PG_ARGISNULL(SECTION_EXAGGERATION) ? 1 :
		PG_GETARG_FLOAT8(SECTION_EXAGGERATION);
	drawing.width = drawing_pixels(fcinfo, SECTION_WIDTH, 1024, "width");
	drawing.height = drawing_pixels(fcinfo, SECTION_HEIGHT, 0, "height");
	drawing.attribute = attribute_or_label(fcinfo, SECTION_ATTRIBUTE, SECTION_STEP, abacus_names_of(&reader->header));
	drawing.edges = PG_ARGISNULL(SECTION_EDGES) || PG_GETARG_BOOL(SECTION_EDGES);
	drawing.extent.max_edge = extent_max_edge(fcinfo, SECTION_MAX_EDGE);
	drawing_range(fcinfo, SECTION_RANGE, &drawing);
	style(fcinfo, SECTION_STYLE, &drawing);
	leave_contours_out(&reader->header.facts, &drawing);
	window(&reader->header.facts.form, array(fcinfo, SECTION_LOWER), array(fcinfo, SECTION_UPPER), &drawing);

	host_run(host, abacus_draw_section, &host->table, &reader->header.facts, &section, &drawing,
			 &picture);
	if (picture.is_blank)
		tell_blank(reader, &drawing, "tetrahedra",
				   PG_ARGISNULL(SECTION_LOWER) ? "cut by the plane" :
				   "cut by the plane in the window");
	PG_RETURN_BYTEA_P(drawing_finish(host, &picture));
}

/* Arguments of abacus_draw_volume */
enum
{
	VOLUME_MESH,
	VOLUME_EYE,
	VOLUME_TOWARD,
	VOLUME_UP,
	VOLUME_FIELD_OF_VIEW,
	VOLUME_WIDTH,
	VOLUME_HEIGHT,
	VOLUME_ATTRIBUTE,
	VOLUME_MODE,
	VOLUME_LOWER,
	VOLUME_UPPER,
	VOLUME_MAX_EDGE,
	VOLUME_RANGE,
	VOLUME_RAMP,
	VOLUME_LEGEND,
	VOLUME_TRANSPARENT,
	VOLUME_STEP
};

/* In the order of the core's numbers */
static const char *const ray_modes[] = {"mean", "max", "min", "sum", NULL};

/* A point or direction of the camera; false if not given. */
static bool
camera_vector(FunctionCallInfo fcinfo, int argument, const abacus_form *form, const char *name,
			  double *vector)
{
	if (PG_ARGISNULL(argument))
		return false;
	shape_point(form, PG_GETARG_ARRAYTYPE_P(argument), name, vector);
	return true;
}

static void
camera_arguments(FunctionCallInfo fcinfo, const abacus_form *form, abacus_camera *camera)
{
	camera->has_eye = camera_vector(fcinfo, VOLUME_EYE, form, "eye", camera->eye);
	camera->has_toward = camera_vector(fcinfo, VOLUME_TOWARD, form, "toward", camera->toward);
	camera->has_up = camera_vector(fcinfo, VOLUME_UP, form, "up", camera->up);
	camera->field_of_view = PG_ARGISNULL(VOLUME_FIELD_OF_VIEW) ? 0
		: PG_GETARG_FLOAT8(VOLUME_FIELD_OF_VIEW);
	camera->mode = word_argument(fcinfo, VOLUME_MODE, ray_modes, "mode",
								 "Use mean, max, min or sum.");
}

/*
 * abacus_draw_volume(mesh regclass, eye float8[], toward float8[], up float8[],
 * field_of_view float8, width int, height int, attribute text, mode text,
 * lower float8[], upper float8[], max_edge float8, range float8[], ramp text,
 * legend text, transparent boolean, step int8) -> bytea
 */
Datum
abacus_sql_draw_volume(PG_FUNCTION_ARGS)
{
	Reader	   *reader;
	Host	   *host;
	abacus_camera camera = {0};
	abacus_drawing drawing = {0};
	abacus_picture picture = {0};

	if (PG_ARGISNULL(VOLUME_MESH))
		PG_RETURN_NULL();
	reader = reader_open(PG_GETARG_OID(VOLUME_MESH), CurrentMemoryContext);
	host = reader->host;
	header_require_dimension(&reader->header.facts.form, 3, "Use abacus_draw for a mesh of dimension 2.");
	step_argument(fcinfo, VOLUME_STEP, reader);
	camera_arguments(fcinfo, &reader->header.facts.form, &camera);
	drawing.width = drawing_pixels(fcinfo, VOLUME_WIDTH, 1024, "width");
	drawing.height = drawing_pixels(fcinfo, VOLUME_HEIGHT, 0, "height");
	drawing.attribute = step_or_attribute(fcinfo, VOLUME_STEP, VOLUME_ATTRIBUTE, abacus_names_of(&reader->header));
	drawing.extent.max_edge = extent_max_edge(fcinfo, VOLUME_MAX_EDGE);
	if (!PG_ARGISNULL(VOLUME_RANGE))
		shape_range(PG_GETARG_ARRAYTYPE_P(VOLUME_RANGE), "range", drawing.range);
	if (!PG_ARGISNULL(VOLUME_RAMP))
		drawing.ramp = drawing_ramp_argument(fcinfo, VOLUME_RAMP);
	drawing.legend = caption(fcinfo, VOLUME_LEGEND);
	drawing.transparent = drawing_flag(fcinfo, VOLUME_TRANSPARENT);
	window(&reader->header.facts.form, array(fcinfo, VOLUME_LOWER), array(fcinfo, VOLUME_UPPER), &drawing);

	progress_begin(&host->progress, PG_GETARG_OID(VOLUME_MESH));
	host_run(host, abacus_draw_volume, &host->table, &reader->header.facts, &camera, &drawing, &picture);
	progress_end(&host->progress);
	if (picture.is_blank)
		tell_blank(reader, &drawing, "tetrahedra", "met by a ray");
	PG_RETURN_BYTEA_P(drawing_finish(host, &picture));
}
