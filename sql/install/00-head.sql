\echo Use "CREATE EXTENSION abacus" to load this file. \quit
