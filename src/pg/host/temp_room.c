/*
 * temp_room.c: whether there is room for temporary files, before they are written.
 *
 * PostgreSQL would notice only while writing, perhaps an hour and a full disk later.
 */
#include "postgres.h"

#include <math.h>
#include <sys/stat.h>
#include <sys/statvfs.h>

#include "commands/tablespace.h"
#include "miscadmin.h"
#include "storage/fd.h"
#include "utils/guc.h"

#include "pg/host/temp_room.h"
#include "pg/port/port.h"

#define MOST_TABLESPACES 64

/*
 * Free bytes of the file system where a tablespace has its temporary files; negative if unknown.
 */
static double
free_bytes(Oid tablespace, dev_t *device)
{
	char		path[MAXPGPATH];
	struct stat folder;
	struct statvfs disk;

	TempTablespacePath(path, tablespace);
	if (stat(path, &folder) != 0)
		get_parent_directory(path); /* the folder is made with the first file */
	if (stat(path, &folder) != 0 || statvfs(path, &disk) != 0)
		return -1;
	*device = folder.st_dev;
	return (double) disk.f_bavail * (double) disk.f_frsize;
}

/* The same for all tablespaces over which temporary files are spread. */
static double
all_free_bytes(void)
{
	Oid			tablespaces[MOST_TABLESPACES];
	dev_t		devices[MOST_TABLESPACES];
	int			count,
				known = 0;
	double		sum = 0;

	PrepareTempTablespaces();
	count = GetTempTablespaces(tablespaces, MOST_TABLESPACES);
	if (count == MOST_TABLESPACES)
		return -1;				/* there may be more */
	if (count == 0)
		tablespaces[count++] = InvalidOid;
	for (int i = 0; i < count; i++)
	{
		Oid			tablespace = OidIsValid(tablespaces[i]) ? tablespaces[i] : MyDatabaseTableSpace;
		double		bytes = free_bytes(tablespace, &devices[known]);
		int			same = 0;

		if (bytes < 0)
			return -1;
		while (devices[same] != devices[known])
			same++;
		if (same < known)
			continue;
		known++;
		sum += bytes;
	}
	return sum;
}

pg_noreturn static void
refuse(double bytes, const char *limit, const char *hint)
{
	ereport(ERROR,
			(errcode(ERRCODE_CONFIGURATION_LIMIT_EXCEEDED),
			 errmsg("temporary files would take more than %s", limit),
			 errdetail("They would take at least %.0f MB.", ceil(bytes / (1024 * 1024))),
			 errhint("%s", hint)));
}

bool
temp_room_has(double bytes)
{
	double		room;

	if (temp_file_limit >= 0 && bytes > (double) temp_file_limit * 1024)
		return false;
	room = all_free_bytes();
	return room < 0 || bytes <= room;
}

/* An error unless temporary files may grow by this many bytes. */
void
temp_room_require(double bytes)
{
	double		room;

	if (temp_file_limit >= 0 && bytes > (double) temp_file_limit * 1024)
		refuse(bytes, psprintf("temp_file_limit (%d kB)", temp_file_limit),
			   "Ask for less, or for one part at a time, or have temp_file_limit raised.");
	room = all_free_bytes();
	if (room >= 0 && bytes > room)
		refuse(bytes, psprintf("the %.0f MB free on the disk", floor(room / (1024 * 1024))),
			   "Ask for less, or for one part at a time, or name a tablespace with more room in temp_tablespaces.");
}

/* The same for rows of a tuplestore, each of at least this many bytes. */
void
temp_room_require_rows(double rows, int bytes_per_row)
{
	double		bytes = rows * bytes_per_row;

	if (bytes > (double) work_mem * 1024)
		temp_room_require(bytes);
}
