# For tools that call plain make, as those of PGXN and of Debian do: the extension alone.
include $(dir $(firstword $(MAKEFILE_LIST)))Makefile.pgxs
