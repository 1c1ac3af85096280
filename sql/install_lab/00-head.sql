\echo Use "CREATE EXTENSION abacus_lab" to load this file. \quit
