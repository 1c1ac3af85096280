CREATE FUNCTION abacus_version()
RETURNS text
AS 'MODULE_PATHNAME', 'abacus_sql_version'
LANGUAGE C STABLE PARALLEL SAFE;
COMMENT ON FUNCTION abacus_version() IS 'the version of the loaded module. Errors: none';
