/* flock() of a file system that fails with the error NO_LOCKS, a number: preloaded into the program by shared_folders.rs. */
#include <errno.h>
#include <stdlib.h>

int flock(int file, int operation)
{
    const char *error = getenv("NO_LOCKS");
    (void)file;
    (void)operation;
    errno = error ? atoi(error) : EOPNOTSUPP;
    return -1;
}
