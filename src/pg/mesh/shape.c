/*
 * shape.c: the shape of a new mesh: dimension, attributes, labels, domain.
 */
#include "postgres.h"

#include <math.h>

#include "catalog/pg_type.h"
#include "utils/builtins.h"

#include "pg/mesh/header.h"
#include "pg/mesh/shape.h"

void
shape_dimension(abacus_form *form, int32 dimension)
{
	if (dimension < 2 || dimension > ABACUS_MAX_DIMENSION)
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
				 errmsg("dimension must be 2 or 3, not %d", dimension)));
	form->dimension = (uint32) dimension;
}

void
shape_check_name(const char *name)
{
	if (name[0] == '\0' || strlen(name) >= ABACUS_NAME_BYTES)
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_NAME),
				 errmsg("invalid attribute name \"%s\"", name),
				 errhint("Use a name of 1 to %d bytes.", ABACUS_NAME_BYTES - 1)));
}

/* An error if one more attribute would be too many. */
void
shape_check_room(const abacus_facts *facts)
{
	bool		is_octree = facts->form.type == ABACUS_OCTREE;
	uint32		most = is_octree ? ABACUS_MAX_PAGE_ATTRIBUTES : ABACUS_MAX_ATTRIBUTES;

	if (facts->columns.attributes == most)
		ereport(ERROR,
				(errcode(ERRCODE_PROGRAM_LIMIT_EXCEEDED),
				 errmsg("%s can have at most %u attributes", is_octree ? "an octree" : "a mesh", most),
				 is_octree ? 0 : errhint("Drop attributes that are not needed with "
										 "abacus_drop_attribute(), or keep them in another mesh.")));
}

/* An error if a mesh with split nodes cannot have so many attributes. */
void
shape_check_split(uint32 attributes)
{
	if (attributes > ABACUS_MAX_PAGE_ATTRIBUTES)
		ereport(ERROR,
				(errcode(ERRCODE_PROGRAM_LIMIT_EXCEEDED),
				 errmsg("a mesh with split nodes can have at most %u attributes",
						ABACUS_MAX_PAGE_ATTRIBUTES),
				 errhint("Name only the attributes that are needed, and keep the others in a table by id.")));
}

/* Adds one attribute. */
void
shape_attribute(abacus_header *header, const char *name)
{
	shape_check_room(&header->facts);
	shape_check_name(name);
	if (header_attribute(abacus_names_of(header), name) >= 0)
		ereport(ERROR,
				(errcode(ERRCODE_DUPLICATE_COLUMN),
				 errmsg("attribute \"%s\" is named twice", name),
				 errhint("Give each column of the query its own name with AS; attributes are named "
						 "after columns.")));
	header->types[header->facts.columns.attributes] = ABACUS_FLOAT8;
	strlcpy(header->names[header->facts.columns.attributes++], name, ABACUS_NAME_BYTES);
}

/* Adds one label of simplices, after all attributes. */
void
shape_label(abacus_header *header, const char *name)
{
	uint32		names = header->facts.columns.attributes + header->facts.columns.labels;

	if (header->facts.columns.labels == ABACUS_MAX_LABELS)
		ereport(ERROR,
				(errcode(ERRCODE_PROGRAM_LIMIT_EXCEEDED),
				 errmsg("a mesh can have at most %d labels", ABACUS_MAX_LABELS)));
	shape_check_name(name);
	for (uint32 i = 0; i < names; i++)
		if (strcmp(header->names[i], name) == 0)
			ereport(ERROR,
					(errcode(ERRCODE_DUPLICATE_COLUMN),
					 i < header->facts.columns.attributes
					 ? errmsg("\"%s\" is both an attribute and a label", name)
					 : errmsg("label \"%s\" is named twice", name)));
	header->types[names] = ABACUS_FLOAT8;
	strlcpy(header->names[names], name, ABACUS_NAME_BYTES);
	header->facts.columns.labels++;
}

/* Elements of a one-dimensional array without NULLs; `what` names it for messages. */
static Datum *
plain_elements(ArrayType *array, const char *what, Oid type, int16 length, bool by_value,
			   char align, int *count)
{
	Datum	   *elements;

	if (ARR_NDIM(array) > 1 || array_contains_nulls(array))
		ereport(ERROR,
				(errcode(ERRCODE_ARRAY_SUBSCRIPT_ERROR),
				 errmsg("%s must be a one-dimensional array without NULLs", what)));
	deconstruct_array(array, type, length, by_value, align, &elements, NULL, count);
	return elements;
}

/* Elements of a text[]. */
Datum *
shape_names(ArrayType *names, const char *what, int *count)
{
	return plain_elements(names, what, TEXTOID, -1, false, TYPALIGN_INT, count);
}

/* Adds all attributes of a text[]. */
void
shape_attributes(abacus_header *header, ArrayType *names)
{
	int			count;
	Datum	   *elements = shape_names(names, "attributes", &count);

	for (int i = 0; i < count; i++)
		shape_attribute(header, TextDatumGetCString(elements[i]));
}

/* Elements of a float8[]. */
Datum *
shape_numbers(ArrayType *numbers, const char *what, int *count)
{
	return plain_elements(numbers, what, FLOAT8OID, sizeof(float8), FLOAT8PASSBYVAL,
						  TYPALIGN_DOUBLE, count);
}

/* Reads a float8[] with one element for each dimension of the mesh. */
void
shape_point(const abacus_form *form, ArrayType *point, const char *what, double *values)
{
	int			count;
	Datum	   *elements = shape_numbers(point, what, &count);

	if (count != (int) form->dimension)
		ereport(ERROR,
				(errcode(ERRCODE_ARRAY_SUBSCRIPT_ERROR),
				 errmsg("%s has %d elements, but the %s has dimension %u", what, count,
						type_name(form->type), form->dimension),
				 count == 3 ? errhint("To make one in space, use dimension => 3.") : 0));
	for (int i = 0; i < count; i++)
		values[i] = DatumGetFloat8(elements[i]);
}

/* Reads a float8[] of two values. */
void
shape_pair(ArrayType *pair, const char *what, double *values)
{
	int			count;
	Datum	   *elements = shape_numbers(pair, what, &count);

	if (count != 2)
		ereport(ERROR,
				(errcode(ERRCODE_ARRAY_SUBSCRIPT_ERROR),
				 errmsg("%s has %d elements, not 2", what, count)));
	for (int i = 0; i < count; i++)
		values[i] = DatumGetFloat8(elements[i]);
}

/* Reads a float8[] of two finite values, the lesser one first. */
void
shape_range(ArrayType *range, const char *what, double *values)
{
	shape_pair(range, what, values);
	if (!isfinite(values[0]) || !isfinite(values[1]) || !(values[0] < values[1]))
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
				 errmsg("%s must be two finite values, the lesser one first", what)));
}

/* The domain, if both corners are given; else it comes from the first points. */
void
shape_domain(abacus_form *form, ArrayType *lower, ArrayType *upper)
{
	if (lower == NULL && upper == NULL)
		return;
	if (lower == NULL || upper == NULL)
		ereport(ERROR,
				(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
				 errmsg("lower and upper must be given together"),
				 errhint("Leave both out to take them from the points.")));
	shape_point(form, lower, "lower", form->lower);
	shape_point(form, upper, "upper", form->upper);
	for (uint32 i = 0; i < form->dimension; i++)
		if (!isfinite(form->lower[i]) || !isfinite(form->upper[i]) ||
			!(form->lower[i] < form->upper[i]))
			ereport(ERROR,
					(errcode(ERRCODE_INVALID_PARAMETER_VALUE),
					 errmsg("lower must be less than upper, and both must be finite, on axis %c",
							"xyz"[i])));
	form->has_domain = 1;
}
