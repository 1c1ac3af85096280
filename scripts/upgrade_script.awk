# The part of an upgrade that repeats the installation: awk -f upgrade_script.awk RELEASED SCRIPT...
#
# Functions, procedures and views become as they are in the scripts. Of what cannot be replaced, namely types, foreign
# data wrappers and servers, only those are made that the released version lacks. If one has changed since, the file of
# the upgrade says how.

# What the line begins to make.
function made() {
    return match($0, /^CREATE (TYPE|FOREIGN DATA WRAPPER|SERVER) [a-z_]+/) ? substr($0, 1, RLENGTH) : ""
}

FILENAME == ARGV[1] {
    if (made() != "") released[made()] = 1
    next
}

made() in released { leaving_out = 1 }

!leaving_out {
    if (/^CREATE (FUNCTION|PROCEDURE|VIEW) /) sub(/^CREATE/, "CREATE OR REPLACE")
    print
}

/;[ \t]*(--.*)?$/ { leaving_out = 0 }
