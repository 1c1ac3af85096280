\echo Use "CREATE EXTENSION abacus_postgis" to load this file. \quit
