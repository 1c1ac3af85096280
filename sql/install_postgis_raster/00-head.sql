\echo Use "CREATE EXTENSION abacus_postgis_raster" to load this file. \quit
