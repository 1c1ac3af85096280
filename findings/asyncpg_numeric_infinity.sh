#!/bin/bash
# asyncpg reads the infinite values of PostgreSQL's numeric as 0.
#
# Version     asyncpg 0.27.0 (Debian 12: python3-asyncpg 0.27.0-1+b2), PostgreSQL 15
# Behaviour   numeric has Infinity and -Infinity since PostgreSQL 14. They become Decimal('0E-32'), in columns
#             and in arrays, without a warning. NaN is right, and so is Infinity in float8. psycopg2
#             2.9.5 gives Decimal('Infinity').
# Output      [Decimal('1.10'), Decimal('NaN'), Decimal('0E-32'), Decimal('0E-32')]
# Expected    Decimal('Infinity') and Decimal('-Infinity'), or an error.
# Way out     Cast to float8 or text in SQL.
set -euo pipefail
. "$(dirname "$0")/tools.bash"

unpack python3-asyncpg=0.27.0-1+b2 python3-psycopg2=2.9.5-1+b1 \
    postgresql-15=15.20-0+deb12u1 postgresql-client-15=15.20-0+deb12u1 libpq5=15.20-0+deb12u1
start_server

cat >"$tmp/infinite.py" <<'PYTHON'
import asyncio
import sys
import warnings

import asyncpg
import psycopg2

warnings.simplefilter("error")


def expect(what, expected, found):
    if str(found) != str(expected):
        sys.exit(f"CHANGED: {what}\n  it was: {expected}\n  it is:  {found}")
    print(f"{what}: {found}")


async def main(directory):
    connection = await asyncpg.connect(host=directory, user="owner", database="postgres")
    expect("version", "0.27.0", asyncpg.__version__)
    array = "SELECT '{1.10, NaN, Infinity, -Infinity}'::numeric[]"
    expect("array", "[Decimal('1.10'), Decimal('NaN'), Decimal('0E-32'), Decimal('0E-32')]", await connection.fetchval(array))
    expect("column", "0E-32", await connection.fetchval("SELECT 'Infinity'::numeric"))
    expect("float8", "inf", await connection.fetchval("SELECT 'Infinity'::numeric::float8"))
    expect("text", "Infinity", await connection.fetchval("SELECT 'Infinity'::numeric::text"))
    await connection.close()
    with psycopg2.connect(host=directory, user="owner", dbname="postgres").cursor() as cursor:
        cursor.execute(array)
        expect("psycopg2", "[Decimal('1.10'), Decimal('NaN'), Decimal('Infinity'), Decimal('-Infinity')]", cursor.fetchone()[0])


asyncio.run(main(sys.argv[1]))
PYTHON
PYTHONPATH=$tmp/usr/lib/python3/dist-packages LD_LIBRARY_PATH=$libraries /usr/bin/python3 "$tmp/infinite.py" "$tmp"
