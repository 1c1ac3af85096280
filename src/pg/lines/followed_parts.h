/*
 * followed_parts.h: lines of a table that a mesh follows, for the files that share the work.
 */
#ifndef ABACUS_FOLLOWED_PARTS_H
#define ABACUS_FOLLOWED_PARTS_H

#include "pg/lines/followed_lines.h"

/* Rows with names: vertices that changed lines had made. */
#define MADE_GONE "abacus_made_gone"	/* no other line names them */
#define MADE_KEPT "abacus_made_kept"	/* other lines name them */

struct FollowedLines
{
	Change	   *change;
	char	   *table;			/* of the lines of the mesh, as SQL */
	bool		all;			/* every line has changed */
	bool		is_compared;	/* those that have changed were found by a comparison */
	NamedRows  *noted;
	NamedRows  *places;
	NamedRows  *changed;
	NamedRows  *rows;			/* of the lines that come; like the others NULL until there are some */
	NamedRows  *kinds;
	NamedRows  *gone;
	NamedRows  *kept;
	NamedRows  *found;			/* while the points of lines are looked for */
	NewLines	lines;
	const char *kind;
	int64		least;			/* ids of vertices that are made are less */
};

extern void followed_points_remove(FollowedLines *lines);
extern NamedRows *followed_points_find(FollowedLines *lines);

#endif
