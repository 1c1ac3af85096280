-- Live figures of the builds, and of other long work, that run in any session.
--
-- The slots are those that src/pg/host/progress.c fills. Like the progress views of
-- PostgreSQL it shows figures of other users' sessions only to members of
-- pg_read_all_stats.
--
-- Operands have exactly the types of a built-in operator. If they needed a conversion,
-- an operator that somebody has made for just these types, in the schema of the
-- extension, would be chosen, and everybody who reads the view would run it.

CREATE VIEW abacus_progress AS
WITH build AS (
    SELECT s.pid,
           CASE WHEN s.datid = d.oid THEN s.relid END AS relid,
           s.param11 AS phase,
           s.param13 AS done,
           nullif(s.param12, 0) AS total,
           extract(epoch FROM clock_timestamp()) - 946684800.0 - s.param18::numeric / 1e6 AS phase_seconds,
           extract(epoch FROM clock_timestamp()) - 946684800.0 - s.param19::numeric / 1e6 AS seconds,
           s.param2 AS pages_read,
           s.param3 AS pages_written,
           greatest(s.param8 & 65535::bigint, 1::bigint) AS threads,
           ((s.param8 >> 16) & 8388607::bigint)::double precision / 1000.0::double precision AS busy,
           (s.param8 >> 39)::double precision / 1000.0::double precision AS session_busy
    FROM pg_catalog.pg_stat_get_progress_info('CREATE INDEX') AS s,
         pg_catalog.pg_database AS d
    WHERE d.datname = current_database()
      AND s.param20 = 107075168597363 -- 0x616261637573, "abacus"
)
SELECT pid,
       relid::regclass AS mesh,
       CASE phase
           WHEN 0 THEN 'starting'
           WHEN 1 THEN 'reading'
           WHEN 2 THEN 'sorting'
           WHEN 3 THEN 'staging'
           WHEN 4 THEN 'inserting'
           WHEN 5 THEN 'flushing'
           WHEN 6 THEN 'checking'
           WHEN 7 THEN 'deleting'
           WHEN 8 THEN 'locating'
           WHEN 9 THEN 'scanning'
           WHEN 20 THEN 'spreading'
           WHEN 21 THEN 'triangulating'
           WHEN 22 THEN 'exchanging'
       END AS phase,
       done,
       total,
       (done::numeric / nullif(phase_seconds, 0.0))::double precision AS per_second,
       make_interval(secs => ((total - done)::numeric * phase_seconds / nullif(done, 0)::numeric)::double precision)
           AS time_left,
       make_interval(secs => seconds::double precision) AS elapsed,
       CASE WHEN phase < 20 THEN pages_read END AS pages_read,
       CASE WHEN phase < 20 THEN pages_written END AS pages_written,
       threads,
       busy,
       session_busy,
       CASE WHEN phase = 22 THEN pages_read END AS rounds
FROM build;
COMMENT ON VIEW abacus_progress IS 'live figures of the builds, changes, loads, checks, locations of many places and surfaces that run in any session';
COMMENT ON COLUMN abacus_progress.pid IS 'process id of the session';
COMMENT ON COLUMN abacus_progress.mesh IS 'the mesh; a number while its creation is not committed, NULL in another database';
COMMENT ON COLUMN abacus_progress.phase IS 'starting, reading, sorting, staging, inserting, deleting, flushing, checking, locating or scanning; of a mesh over several servers spreading, triangulating or exchanging';
COMMENT ON COLUMN abacus_progress.done IS 'points or places (checking: pages, each of which is read twice; scanning: simplices; of octrees leaves; triangulating: servers; exchanging: vertices sent) done in this phase';
COMMENT ON COLUMN abacus_progress.total IS 'of how many; NULL if not known';
COMMENT ON COLUMN abacus_progress.per_second IS 'mean rate in this phase';
COMMENT ON COLUMN abacus_progress.time_left IS 'in this phase, at that rate';
COMMENT ON COLUMN abacus_progress.elapsed IS 'since the function began';
COMMENT ON COLUMN abacus_progress.pages_read IS 'pages read back into the cache';
COMMENT ON COLUMN abacus_progress.pages_written IS 'pages written';
COMMENT ON COLUMN abacus_progress.threads IS 'threads that compute at this moment: 1 is the session''s; several work for it, and it serves them';
COMMENT ON COLUMN abacus_progress.busy IS 'processors that all threads together have kept busy since the function began, on average';
COMMENT ON COLUMN abacus_progress.session_busy IS 'what the session''s own thread has taken of one processor since then: near 1, it is what the others wait for';
COMMENT ON COLUMN abacus_progress.rounds IS 'of the exchange between several servers, which one it is; NULL in other phases';
GRANT SELECT ON abacus_progress TO PUBLIC;
