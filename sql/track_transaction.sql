-- Many changes of a mesh in one transaction: versions of pages that it has made and replaced go at once,
-- but for those that a cursor, a savepoint or a statement that is running may see.
CREATE TABLE spots (id int PRIMARY KEY, x float8, y float8);
SELECT abacus_create('spotted', 2);
SELECT abacus_track('spotted', 'spots');
CREATE FUNCTION spots(first int, last int) RETURNS SETOF spots LANGUAGE sql AS $$
    SELECT i, (i * 0.7548776662466927) % 1, (i * 0.5698402909980532) % 1 FROM generate_series(first, last) AS i $$;
INSERT INTO spots SELECT * FROM spots(1, 4000);
CREATE FUNCTION apart() RETURNS bigint LANGUAGE sql AS $$
    WITH there AS (SELECT id, x, y FROM abacus_vertices('spotted'))
    SELECT (SELECT count(*) FROM (TABLE spots EXCEPT ALL TABLE there) a)
         + (SELECT count(*) FROM (TABLE there EXCEPT ALL TABLE spots) b)
         + (SELECT count(*) FROM abacus_check('spotted')) $$;
-- how many times as large as at first
CREATE TABLE sizes AS SELECT pg_relation_size('spotted') AS bytes;
-- 0 in a build without shortcuts, where versions stay until the transaction has ended
CREATE FUNCTION grown() RETURNS bigint LANGUAGE sql AS $$ SELECT current_setting('abacus.shortcuts')::boolean::int * pg_relation_size('spotted') / bytes FROM sizes $$;
CREATE PROCEDURE one_by_one(first int, last int) LANGUAGE plpgsql AS $$
BEGIN
    FOR i IN first .. last LOOP
        INSERT INTO spots SELECT * FROM spots(i, i);
    END LOOP;
END $$;

-- in a procedure, in a DO block, in a function, each row with an exception block of its own
CALL one_by_one(4001, 4500);
SELECT grown() < 8 AS small, apart();
DO $$ BEGIN FOR i IN 4501 .. 5000 LOOP
    INSERT INTO spots SELECT * FROM spots(i, i);
    UPDATE spots SET x = x + 0.001 WHERE id = i;
    DELETE FROM spots WHERE id = i - 10;
END LOOP; END $$;
SELECT grown() < 10 AS small, apart();
CREATE FUNCTION with_exceptions(first int, last int) RETURNS void LANGUAGE plpgsql AS $$
BEGIN
    FOR i IN first .. last LOOP
        BEGIN
            INSERT INTO spots SELECT * FROM spots(i, i);
            PERFORM 1 / (i % 10);
        EXCEPTION WHEN division_by_zero THEN
            NULL;
        END;
    END LOOP;
END $$;
SELECT with_exceptions(5001, 5500);
SELECT grown() < 14 AS small, apart();
-- ... and deeper
CREATE FUNCTION deeper(depth int, first int, last int) RETURNS int LANGUAGE plpgsql AS $$
DECLARE
    same int;
BEGIN
    IF depth = 0 THEN
        CALL one_by_one(first, last);
        RETURN 0;
    END IF;
    same := deeper(depth - 1, first, last);
    RETURN same;
END $$;
SELECT deeper(3, 5501, 5900);
SELECT grown() < 15 AS small, apart();
-- of many changes in one statement, too, and by hand
SELECT abacus_untrack('spotted', 'spots');
SELECT sum(abacus_insert('spotted', format('SELECT * FROM spots(%s, %s)', i, i))) FROM generate_series(6001, 6300) AS i;
SELECT grown() < 16 AS small;
DO $$ BEGIN FOR i IN 6301 .. 6600 LOOP
    PERFORM abacus_insert('spotted', format('SELECT * FROM spots(%s, %s)', i, i));
END LOOP; END $$;
SELECT grown() < 18 AS small;
INSERT INTO spots SELECT * FROM spots(5990, 5999);
SELECT abacus_track('spotted', 'spots', synchronize => true) > 0 AS tracked, apart();

-- a cursor sees what there was when it was opened
BEGIN;
CALL one_by_one(7001, 7010);
CREATE TEMPORARY TABLE before AS SELECT count(*) AS simplices FROM abacus_simplices('spotted');
DECLARE mesh CURSOR FOR SELECT count(*) FROM abacus_simplices('spotted');
CALL one_by_one(7011, 7200);
FETCH ALL FROM mesh \gset mesh_
SELECT :mesh_count = simplices AS same FROM before;
CLOSE mesh;
CALL one_by_one(7201, 7300);
SELECT apart();
-- what comes back comes back
SAVEPOINT one;
CALL one_by_one(7301, 7400);
SAVEPOINT two;
CALL one_by_one(7401, 7500);
DELETE FROM spots WHERE id BETWEEN 7100 AND 7350;
SAVEPOINT three;
CALL one_by_one(7501, 7520);
ROLLBACK TO three;
SELECT apart(), count(*) FROM spots WHERE id > 7000;
CALL one_by_one(7501, 7520);
RELEASE three;
SELECT apart(), count(*) FROM spots WHERE id > 7000;
ROLLBACK TO two;
SELECT apart(), count(*) FROM spots WHERE id > 7000;
RELEASE one;
CALL one_by_one(7401, 7500);
SELECT apart(), count(*) FROM spots WHERE id > 7000;
COMMIT;
SELECT apart(), count(*) FROM spots WHERE id > 7000;
BEGIN;
CALL one_by_one(8001, 8200);
ROLLBACK;
SELECT apart(), count(*) FROM spots WHERE id > 7000;

-- a statement, and an expression, see what there was before them, however deep the changes lie
CREATE FUNCTION simplices() RETURNS bigint STABLE LANGUAGE plpgsql AS $$ BEGIN RETURN (SELECT count(*) FROM abacus_simplices('spotted')); END $$;
CREATE FUNCTION add(first int, last int) RETURNS bigint LANGUAGE plpgsql AS $$ BEGIN CALL one_by_one(first, last); RETURN 0; END $$;
BEGIN;
CALL one_by_one(8001, 8020);
SELECT bool_and(add(8020 + 10 * i - 9, 8020 + 10 * i) + simplices() = before) AS unmoved, count(*)
FROM (SELECT i, (SELECT simplices()) AS before FROM generate_series(1, 5) AS i OFFSET 0) AS s;
DO $$
DECLARE
    before bigint := simplices();
    same boolean;
BEGIN
    same := add(8101, 8130) + simplices() = before;
    RAISE NOTICE 'expression: %, now: %', same, simplices() - before;
    FOR i IN 1 .. 3 LOOP
        before := simplices();
        same := add(8130 + 10 * i - 9, 8130 + 10 * i) + simplices() = before;
        RAISE NOTICE 'expression: %, now: %', same, simplices() > before;
    END LOOP;
END $$;
SELECT apart();
COMMIT;
-- a trigger that is STABLE sees what its statement saw
CREATE FUNCTION look() RETURNS trigger STABLE LANGUAGE plpgsql AS $$
BEGIN
    RAISE NOTICE '% faults', (SELECT count(*) FROM abacus_check('spotted'));
    RETURN NULL;
END $$;
CREATE TRIGGER zz_look AFTER INSERT ON spots FOR EACH STATEMENT EXECUTE FUNCTION look();
BEGIN;
INSERT INTO spots SELECT * FROM spots(9001, 9001);
INSERT INTO spots SELECT * FROM spots(9002, 9002);
INSERT INTO spots SELECT * FROM spots(9003, 9003);
COMMIT;
DROP TRIGGER zz_look ON spots;
BEGIN ISOLATION LEVEL REPEATABLE READ;
CALL one_by_one(9101, 9200);
SELECT apart();
COMMIT;
-- temporary and unlogged ones
CREATE TEMPORARY TABLE moments (LIKE spots);
SELECT abacus_create('pg_temp.passing', 2);
SELECT abacus_track('passing', 'moments');
DO $$ BEGIN FOR i IN 1 .. 600 LOOP INSERT INTO moments SELECT * FROM spots(i, i); END LOOP; END $$;
SELECT current_setting('abacus.shortcuts')::boolean::int * pg_relation_size('passing') < 400000 AS small, count(*) FROM abacus_vertices('passing');
SELECT * FROM abacus_check('passing');

DROP FUNCTION apart, grown, with_exceptions, deeper, simplices, add, look, spots(int, int);
DROP TABLE spotted, spots, sizes, before, passing, moments;
DROP PROCEDURE one_by_one;
