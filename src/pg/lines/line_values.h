/*
 * line_values.h: values of the types that columns of lines may have.
 */
#ifndef ABACUS_LINE_VALUES_H
#define ABACUS_LINE_VALUES_H

extern bool line_value_is_integer(Oid type);
extern bool line_value_is_number(Oid type);
extern int64 line_value_integer(Oid type, Datum value);
extern double line_value_number(Oid type, Datum value);

#endif
