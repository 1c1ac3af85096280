/* utility.h: runs a utility statement of ours as if the caller had sent it. */
#ifndef ABACUS_UTILITY_H
#define ABACUS_UTILITY_H

extern void utility_run(const char *command);

#endif
