/*
 * geometry_text.c: which texts are geometries, and where they end.
 *
 * A name of a region may look much like one: 'Point (north)', or a number of many digits. So WKT needs a
 * number or another parenthesis in its parentheses, and WKB a type that there is. GEOS reads a geometry
 * and ignores what follows; here it is found.
 */
#include "postgres.h"

#include <ctype.h>

#include "pg/geos/geometry_text.h"

typedef struct Kind
{
	const char *word;
	bool		has_words;		/* in its parentheses: geometries by their names */
	bool		is_read;		/* by GEOS, which must not see collections: they may nest without end */
} Kind;

/* None begins with another one before it. */
static const Kind kinds[] = {
	{"MultiPolygon", false, true}, {"Polygon", false, true}, {"MultiPoint", false, false},
	{"Point", false, false}, {"MultiLineString", false, false}, {"LineString", false, false},
	{"LinearRing", false, false}, {"GeometryCollection", true, false}, {"CurvePolygon", true, false},
	{"CompoundCurve", true, false}, {"MultiCurve", true, false}, {"CircularString", false, false},
	{"MultiSurface", true, false}, {"Tin", false, false}, {"Triangle", false, false},
	{"PolyhedralSurface", false, false}
};

/* The same for the numbers of types in WKB, from 1 on. */
#define WKB_POLYGON 3
#define WKB_MULTIPOLYGON 6
#define MOST_WKB_TYPE 17

static const char *
behind_spaces(const char *text)
{
	while (isspace((unsigned char) *text))
		text++;
	return text;
}

/* Behind spaces and "SRID=number;", if a text begins so. */
const char *
geometry_text_behind_srid(const char *text, int32 *srid)
{
	char	   *end;
	long		number;

	*srid = 0;
	text = behind_spaces(text);
	if (pg_strncasecmp(text, "SRID=", 5) != 0)
		return text;
	number = strtol(text + 5, &end, 10);
	if (end == text + 5 || *end != ';' || number < 0 || number > PG_INT32_MAX)
		return text;
	*srid = (int32) number;
	return behind_spaces(end + 1);
}

/* ---- WKT -------------------------------------------------------------------------------- */

/* The kind of a geometry in WKT, and what follows its word and the letters of its dimension; or NULL. */
static const Kind *
wkt_kind(const char *text, const char **rest)
{
	for (size_t i = 0; i < lengthof(kinds); i++)
	{
		size_t		length = strlen(kinds[i].word);
		const char *at = text + length;
		const char *inner;

		if (pg_strncasecmp(text, kinds[i].word, length) != 0)
			continue;
		at = behind_spaces(at);
		for (int letters = 0; letters < 2 && *at != '\0' && strchr("zmZM", *at) != NULL; letters++)
			at++;
		at = behind_spaces(at);
		*rest = at;
		if (pg_strncasecmp(at, "EMPTY", 5) == 0 && *behind_spaces(at + 5) == '\0')
			return &kinds[i];
		if (*at != '(')
			return NULL;
		inner = behind_spaces(at + 1);
		return *inner != '\0' && (strchr("(+-.0123456789", *inner) != NULL || (kinds[i].has_words && isalpha((unsigned char) *inner)))
			? &kinds[i] : NULL;
	}
	return NULL;
}

/* What follows the parenthesis that closes the first one. */
static const char *
behind_parentheses(const char *text)
{
	int			open = 0;

	for (; *text != '\0'; text++)
	{
		open += (*text == '(') - (*text == ')');
		if (open <= 0)
			return text + 1;
	}
	return text;
}

/* ---- WKB -------------------------------------------------------------------------------- */

/* Bytes of WKB in hexadecimal digits. */
typedef struct Bytes
{
	const char *at;
	size_t		left;			/* of them */
	bool		is_big;
} Bytes;

static int
nibble(char digit)
{
	return isdigit((unsigned char) digit) ? digit - '0' : tolower((unsigned char) digit) - 'a' + 10;
}

static int
take_byte(Bytes *bytes)
{
	int			byte = nibble(bytes->at[0]) * 16 + nibble(bytes->at[1]);

	bytes->at += 2;
	bytes->left--;
	return byte;
}

static bool
take_word(Bytes *bytes, uint32 *word)
{
	if (bytes->left < 4)
		return false;
	*word = 0;
	for (int i = 0; i < 4; i++)
		*word |= (uint32) take_byte(bytes) << 8 * (bytes->is_big ? 3 - i : i);
	return true;
}

static bool
skip_bytes(Bytes *bytes, uint64 count)
{
	if (bytes->left < count)
		return false;
	bytes->at += 2 * count;
	bytes->left -= count;
	return true;
}

/* The head of a geometry: its type from 1 on, and how many coordinates a place has; false if there is none. */
static bool
take_head(Bytes *bytes, uint32 *type, int *coordinates)
{
	int			order;
	uint32		flags;
	uint32		more;

	if (bytes->left < 5)
		return false;
	order = take_byte(bytes);
	bytes->is_big = order == 0;
	if (order > 1 || !take_word(bytes, type))
		return false;
	flags = *type >> 28;
	*type &= 0x0fffffff;
	more = *type / 1000;		/* ISO: Z, M, ZM */
	*type %= 1000;
	*coordinates = 2 + ((flags & 8) != 0) + ((flags & 4) != 0) + (more == 1 || more == 2) + 2 * (more == 3);
	if (*type == 0 || *type > MOST_WKB_TYPE || more > 3 || (flags & 1) != 0)
		return false;
	return (flags & 2) == 0 || skip_bytes(bytes, 4);
}

/* Goes behind a polygon whose head was taken; false if it does not end. */
static bool
skip_rings(Bytes *bytes, int coordinates)
{
	uint32		rings;
	uint32		points;

	if (!take_word(bytes, &rings))
		return false;
	for (; rings > 0; rings--)
		if (!take_word(bytes, &points) || !skip_bytes(bytes, (uint64) points * coordinates * sizeof(double)))
			return false;
	return true;
}

/* Goes behind a Polygon or a MultiPolygon, which has nothing but polygons; false if it is neither, or does not end. */
static bool
skip_polygons(Bytes *bytes)
{
	uint32		type;
	uint32		parts;
	int			coordinates;

	if (!take_head(bytes, &type, &coordinates))
		return false;
	if (type == WKB_POLYGON)
		return skip_rings(bytes, coordinates);
	if (type != WKB_MULTIPOLYGON || !take_word(bytes, &parts))
		return false;
	for (; parts > 0; parts--)
		if (!take_head(bytes, &type, &coordinates) || type != WKB_POLYGON || !skip_rings(bytes, coordinates))
			return false;
	return true;
}

static Bytes
bytes_of(const char *text)
{
	return (Bytes) {text, strlen(text) / 2, false};
}

static bool
is_hexadecimal(const char *text)
{
	size_t		length = strlen(text);
	Bytes		bytes = bytes_of(text);
	uint32		type;
	int			coordinates;

	return length >= 18 && length % 2 == 0 && strspn(text, "0123456789abcdefABCDEF") == length &&
		take_head(&bytes, &type, &coordinates);
}

/* ---- Both ------------------------------------------------------------------------------- */

/* Whether a text is a geometry, and no name. */
GeometryText
geometry_text(const char *text)
{
	int32		srid;
	const char *rest;

	text = geometry_text_behind_srid(text, &srid);
	if (is_hexadecimal(text))
		return GEOMETRY_HEX;
	return wkt_kind(text, &rest) != NULL ? GEOMETRY_WKT : NO_GEOMETRY;
}

/* What follows a geometry that GEOS has read; "" if nothing does. */
const char *
geometry_text_excess(const char *text)
{
	int32		srid;
	const char *rest;

	text = geometry_text_behind_srid(text, &srid);
	if (is_hexadecimal(text))
	{
		Bytes		bytes = bytes_of(text);

		return skip_polygons(&bytes) ? bytes.at : "";
	}
	if (wkt_kind(text, &rest) == NULL)
		return "";
	return *rest == '(' ? behind_spaces(behind_parentheses(rest)) : "";
}

/*
 * The name of a geometry that is no Polygon or MultiPolygon; NULL if it is one. So GEOS gets nothing
 * else, whatever the text has. A polygon in WKB that does not end is a "geometry that is not made of whole polygons".
 */
const char *
geometry_text_other(const char *text)
{
	static const char *const of_wkb[] = {
		"Point", "LineString", "Polygon", "MultiPoint", "MultiLineString", "MultiPolygon", "GeometryCollection",
		"CircularString", "CompoundCurve", "CurvePolygon", "MultiCurve", "MultiSurface", "Curve", "Surface",
		"PolyhedralSurface", "Tin", "Triangle"
	};
	int32		srid;
	const char *rest;
	const Kind *kind;

	text = geometry_text_behind_srid(text, &srid);
	if (is_hexadecimal(text))
	{
		Bytes		bytes = bytes_of(text);
		Bytes		whole = bytes_of(text);
		uint32		type = 0;
		int			coordinates;

		take_head(&bytes, &type, &coordinates);
		if (type != WKB_POLYGON && type != WKB_MULTIPOLYGON)
			return of_wkb[type - 1];
		return skip_polygons(&whole) ? NULL : "geometry that is not made of whole polygons";
	}
	kind = wkt_kind(text, &rest);
	return kind == NULL || kind->is_read ? NULL : kind->word;
}
