-- Commands for tables, run on the tables of a mesh.
CREATE TABLE points AS SELECT i AS id, i % 40 AS x, i / 40 AS y, i * 0.5 AS height FROM generate_series(0, 1599) i;
SELECT abacus_triangulate('field', 'TABLE points');
-- all that is stored, and whether it is sound
CREATE FUNCTION state(mesh regclass) RETURNS text LANGUAGE sql AS $$
    SELECT (SELECT count(*) || ' simplices ' || sum(hashint8(v0) # (hashint8(v1) * 2::bigint) # (hashint8(v2) * 4::bigint)) FROM abacus_simplices(mesh)) ||
           (SELECT ', ' || count(*) || ' points ' || sum(hashint8(id) # hashint8(vertex)::bigint) FROM abacus_vertices(mesh)) ||
           (SELECT ', ' || count(*) || ' faults' FROM abacus_check(mesh))
$$;
CREATE TABLE states AS SELECT 1 AS number, state('field');
-- the mesh is that of the last state
CREATE FUNCTION kept() RETURNS boolean LANGUAGE sql AS $$ SELECT state('field') = (SELECT state FROM states ORDER BY number DESC LIMIT 1) $$;
-- and can be changed
CREATE FUNCTION grow(number bigint) RETURNS boolean LANGUAGE plpgsql AS $$
DECLARE
    points bigint := (SELECT count(*) FROM abacus_vertices('field'));
BEGIN
    PERFORM abacus_stage('field', format('SELECT id + %s, x + 0.3, y + 0.1 * %s, height FROM points WHERE id %% 10 = 1', number * 10000, number));
    PERFORM abacus_triangulate('field');
    INSERT INTO states VALUES (grow.number, state('field'));
    RETURN (SELECT count(*) FROM abacus_vertices('field')) = points + 160 AND state('field') ~ ', 0 faults';
END $$;

-- VACUUM, ANALYZE, REINDEX, CLUSTER; each after a change
SELECT grow(2);
VACUUM field, field_vertices;
SELECT kept(), grow(3);
VACUUM FULL field, field_vertices;
SELECT kept(), grow(4);
VACUUM FREEZE field, field_vertices;
SELECT kept(), grow(5);
ANALYZE field, field_vertices;
SELECT kept(), grow(6);
REINDEX TABLE field;
REINDEX TABLE field_vertices;
SELECT kept(), grow(7);
REINDEX TABLE CONCURRENTLY field;
REINDEX INDEX CONCURRENTLY field_vertices_pkey;
SELECT kept(), grow(8);
CLUSTER field USING field_pkey;
CLUSTER field_vertices USING field_vertices_pkey;
SELECT kept(), grow(9);

-- the same within a transaction that has changed the mesh, or will
BEGIN;
SELECT grow(10);
REINDEX TABLE field;
CLUSTER field USING field_pkey;
SELECT kept(), grow(11);
ROLLBACK;
SELECT kept();

-- a session's cache through them, by a locate before and after
CREATE FUNCTION here() RETURNS text LANGUAGE sql STABLE AS $$ SELECT least(v0, v1, v2) || ' ' || greatest(v0, v1, v2) FROM abacus_locate('field', 7.4, 3.3) $$;
CREATE TABLE place AS SELECT here();
VACUUM FULL field;
SELECT here() = (TABLE place) AS same;
REINDEX TABLE CONCURRENTLY field;
SELECT here() = (TABLE place) AS same;
CLUSTER field;
SELECT here() = (TABLE place) AS same;

-- statistics of PostgreSQL's own are of no use to a search, nor in its way
SET enable_indexscan = off;
SET enable_bitmapscan = off;
SELECT kept();
RESET enable_indexscan;
RESET enable_bitmapscan;

-- names, schemas, table spaces, persistence
CREATE SCHEMA regress_elsewhere;
ALTER TABLE field RENAME TO meadow;
ALTER TABLE meadow SET SCHEMA regress_elsewhere;
SELECT state('regress_elsewhere.meadow') = (SELECT state FROM states ORDER BY number DESC LIMIT 1) AS kept;
ALTER TABLE field_vertices RENAME TO "Meadow's points";
ALTER TABLE "Meadow's points" SET SCHEMA regress_elsewhere;
ALTER SCHEMA regress_elsewhere RENAME TO regress_somewhere;
SELECT state('regress_somewhere.meadow') = (SELECT state FROM states ORDER BY number DESC LIMIT 1) AS kept;
ALTER TABLE regress_somewhere.meadow SET SCHEMA public;
ALTER TABLE meadow RENAME TO field;
SELECT kept(), grow(12);
ALTER TABLE regress_somewhere."Meadow's points" SET SCHEMA public;
ALTER TABLE "Meadow's points" RENAME TO field_vertices;
DROP SCHEMA regress_somewhere;
ALTER TABLE field SET TABLESPACE pg_default;
ALTER TABLE field SET UNLOGGED;
SELECT kept(), grow(13);
ALTER TABLE field_vertices SET UNLOGGED;
ALTER TABLE field SET LOGGED;
SELECT kept(), grow(14);
ALTER TABLE field_vertices SET LOGGED;
ALTER TABLE field SET (fillfactor = 90, autovacuum_enabled = off);
SELECT kept(), grow(15);
-- ... within a transaction, taken back
BEGIN;
ALTER TABLE field RENAME TO meadow;
SELECT state('meadow') = (SELECT state FROM states ORDER BY number DESC LIMIT 1) AS kept;
ROLLBACK;
SELECT kept();

-- what makes a table one that Abacus does not write, or not read
CREATE INDEX further ON field ((code + part));
SELECT kept();
SELECT abacus_triangulate('field');
\echo :LAST_ERROR_SQLSTATE
DROP INDEX further;
CREATE INDEX further ON field (code) WHERE part = 0;
SELECT abacus_triangulate('field');
DROP INDEX further;
-- further indexes on the keys are kept
CREATE INDEX further ON field USING hash (code);
CREATE INDEX more ON field (part, code);
CREATE INDEX most ON field_vertices USING brin (first);
SELECT kept(), grow(16);
SELECT count(*) - (SELECT count(*) FROM abacus_check('field')) AS pages INTO pages FROM field;
SET enable_seqscan = off;
SELECT count(*) = (SELECT pages FROM pages) AS all_found FROM field WHERE part >= 0;
SELECT count(*) FROM field WHERE code = -1;
RESET enable_seqscan;
DROP TABLE pages;
DROP INDEX further, more, most;
ALTER TABLE field DROP CONSTRAINT field_pkey;
SELECT count(*) FROM abacus_simplices('field');
ALTER TABLE field ADD PRIMARY KEY (part, code);
SELECT count(*) FROM abacus_simplices('field');
ALTER TABLE field DROP CONSTRAINT field_pkey;
ALTER TABLE field ADD PRIMARY KEY (code, part);
SELECT kept(), grow(17);
-- another primary key of the right kind, made without a long lock
CREATE UNIQUE INDEX CONCURRENTLY another ON field (code, part);
ALTER TABLE field DROP CONSTRAINT field_pkey, ADD CONSTRAINT field_pkey PRIMARY KEY USING INDEX another;
SELECT kept(), grow(18);
ALTER TABLE field ADD COLUMN more int;
ALTER TABLE field NOT OF;
SELECT count(*) FROM abacus_simplices('field');
ALTER TABLE field OF abacus_simplex_page;
SELECT kept(), grow(19);

-- published: subscribers must hear of every change
SET client_min_messages = error;	-- this server's wal_level is too low for them
CREATE PUBLICATION regress_abacus FOR TABLE field, field_vertices;
RESET client_min_messages;
SELECT kept(), grow(21);
ALTER TABLE field REPLICA IDENTITY NOTHING;
SELECT kept();
SELECT abacus_insert('field', 'SELECT 1, 2, 3');
\echo :LAST_ERROR_SQLSTATE
ALTER TABLE field REPLICA IDENTITY FULL;
SELECT kept(), grow(22);
ALTER TABLE field REPLICA IDENTITY DEFAULT;
ALTER PUBLICATION regress_abacus SET TABLE field, field_vertices (page);
SELECT abacus_insert('field', 'SELECT 1, 2, 3');
\echo :LAST_ERROR_SQLSTATE
ALTER PUBLICATION regress_abacus SET (publish = 'insert');
SELECT kept(), grow(23);
DROP PUBLICATION regress_abacus;

-- copies of both tables, out and back; TRUNCATE of one or both
CREATE TABLE copy AS TABLE field;
CREATE TABLE copy_vertices AS TABLE field_vertices;
TRUNCATE field;
SELECT here();
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_triangulate('field');
SELECT fault, message FROM abacus_check('field');
TRUNCATE field_vertices;
SELECT abacus_stage('field', 'TABLE points');
INSERT INTO field SELECT * FROM copy ORDER BY part, code DESC;
SELECT here() = (TABLE place) AS same;
INSERT INTO field_vertices SELECT * FROM copy_vertices;
SELECT kept(), grow(24);
TRUNCATE field, field_vertices;
INSERT INTO field SELECT * FROM copy;
INSERT INTO field_vertices SELECT * FROM copy_vertices;
DELETE FROM states WHERE number = 24;
SELECT kept(), here() = (TABLE place) AS same;
DROP TABLE copy, copy_vertices;

-- TRUNCATE of the vertex table alone: points that waited, or were repeated, are missed
SELECT abacus_triangulate('lost', 'VALUES (1, 0, 0), (2, 4, 0), (3, 4, 4), (4, 0, 4)');
SELECT abacus_stage('lost', 'VALUES (6, 1, 2), (7, 3, 3)');
TRUNCATE lost_vertices;
SELECT count(*) FROM abacus_simplices('lost');
SELECT count(*) FROM abacus_vertices('lost');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_insert('lost', 'SELECT 8, 2, 3');
SELECT fault, message FROM abacus_check('lost');
DROP TABLE lost;
SELECT abacus_triangulate('lost', 'VALUES (1, 0, 0), (2, 4, 0), (3, 4, 4), (4, 4, 4)');
TRUNCATE lost_vertices;
SELECT count(*) FROM abacus_vertices('lost');
\echo :LAST_ERROR_SQLSTATE
SELECT fault, message FROM abacus_check('lost');
DROP TABLE lost;

-- the vertex table alone may go; the mesh says so
BEGIN;
DROP TABLE field_vertices;
SELECT here() = (TABLE place) AS same;
SELECT count(*) FROM abacus_vertices('field');
\echo :LAST_ERROR_SQLSTATE
ROLLBACK;
DROP TABLE field;
SELECT to_regclass('field_vertices') IS NULL AS gone;

-- owners: both tables need theirs
CREATE ROLE regress_abacus_old;
CREATE ROLE regress_abacus_new;
GRANT CREATE ON SCHEMA public TO regress_abacus_old, regress_abacus_new;
GRANT SELECT ON points TO regress_abacus_old, regress_abacus_new;
SET ROLE regress_abacus_old;
SELECT abacus_triangulate('field', 'TABLE points');
RESET ROLE;
ALTER TABLE field OWNER TO regress_abacus_new;
SET ROLE regress_abacus_new;
SELECT (abacus_locate('field', 7.4, 3.3)).v0 IS NOT NULL AS located;
SELECT abacus_triangulate('field');
\echo :LAST_ERROR_SQLSTATE
RESET ROLE;
ALTER TABLE field_vertices OWNER TO regress_abacus_new;
SET ROLE regress_abacus_new;
SELECT abacus_stage('field', 'TABLE points'), abacus_triangulate('field');
RESET ROLE;
REASSIGN OWNED BY regress_abacus_new TO regress_abacus_old;
SELECT relname, relowner::regrole FROM pg_class WHERE relname ~ '^field' AND relkind = 'r' ORDER BY 1;
SET ROLE regress_abacus_old;
SELECT abacus_triangulate('field');
RESET ROLE;
DROP OWNED BY regress_abacus_old;
DROP OWNED BY regress_abacus_new;
SELECT to_regclass('field') IS NULL AND to_regclass('field_vertices') IS NULL AS dropped;
DROP ROLE regress_abacus_old, regress_abacus_new;

-- a schema, and an extension, with meshes
CREATE SCHEMA regress_elsewhere;
SELECT abacus_triangulate('regress_elsewhere.field', 'TABLE points');
SELECT abacus_triangulate('field', 'TABLE points');
\set VERBOSITY terse
DROP SCHEMA regress_elsewhere;
DROP EXTENSION abacus;
DROP SCHEMA regress_elsewhere CASCADE;
SELECT count(*) AS faults FROM abacus_check('field');
DROP EXTENSION abacus CASCADE;
\set VERBOSITY default
SELECT relname FROM pg_class WHERE relname ~ '^(field|abacus)';
SELECT count(*) AS entries FROM pg_depend WHERE classid = 'pg_class'::regclass AND NOT EXISTS (SELECT FROM pg_class WHERE oid = objid);
-- ... into a schema where somebody has operators for all types that have none together
CREATE SCHEMA regress_elsewhere;
DO $$
DECLARE
    name text;
    a text;
    b text;
BEGIN
    FOREACH a IN ARRAY '{smallint,integer,bigint,numeric,real,double precision}'::text[] LOOP
        FOREACH b IN ARRAY '{smallint,integer,bigint,numeric,real,double precision}'::text[] LOOP
            FOREACH name IN ARRAY '{+,-,*,/,=}'::text[] LOOP
                EXECUTE format('CREATE FUNCTION regress_elsewhere.%I(%s, %s) RETURNS %4$s LANGUAGE sql RETURN NULL::%4$s',
                               name, a, b, CASE name WHEN '=' THEN 'boolean' ELSE 'numeric' END);
                EXECUTE format('CREATE OPERATOR regress_elsewhere.%s (LEFTARG = %s, RIGHTARG = %s, FUNCTION = regress_elsewhere.%I)', name, a, b, name);
            END LOOP;
        END LOOP;
    END LOOP;
END $$;
CREATE EXTENSION abacus SCHEMA regress_elsewhere;
SELECT pg_describe_object(classid, objid, objsubid), pg_describe_object(refclassid, refobjid, refobjsubid)
FROM pg_depend
WHERE refclassid = 'pg_operator'::regclass AND refobjid >= 16384 AND classid <> 'pg_operator'::regclass;
SELECT count(*) FROM regress_elsewhere.abacus_progress;
\set VERBOSITY terse
SET client_min_messages = warning;
DROP SCHEMA regress_elsewhere CASCADE;
RESET client_min_messages;
\set VERBOSITY default
CREATE EXTENSION abacus;
SELECT abacus_triangulate('field', 'SELECT id, x, y FROM points');
SELECT here();

DROP TABLE field, points, states, place;
DROP FUNCTION state, kept, grow, here;
