/*
 * line_values.c: values of the types that columns of lines may have.
 */
#include "postgres.h"

#include "catalog/pg_type.h"
#include "utils/builtins.h"
#include "utils/float.h"

#include "pg/lines/line_values.h"

/* Which types ids and positions may have. */
bool
line_value_is_integer(Oid type)
{
	return type == INT2OID || type == INT4OID || type == INT8OID;
}

/* Which types coordinates and attributes may have. */
bool
line_value_is_number(Oid type)
{
	return line_value_is_integer(type) || type == FLOAT4OID || type == FLOAT8OID || type == NUMERICOID;
}

/* A value of an integer type. */
int64
line_value_integer(Oid type, Datum value)
{
	return type == INT8OID ? DatumGetInt64(value)
		: type == INT4OID ? DatumGetInt32(value) : DatumGetInt16(value);
}

/* A value of a type of numbers. */
double
line_value_number(Oid type, Datum value)
{
	switch (type)
	{
		case FLOAT8OID:
			return DatumGetFloat8(value);
		case FLOAT4OID:
			return DatumGetFloat4(value);
		case NUMERICOID:
			return DatumGetFloat8(DirectFunctionCall1(numeric_float8_no_overflow, value));
		default:
			return (double) line_value_integer(type, value);
	}
}
