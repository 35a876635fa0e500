/* Loss of power, for tests (LD_PRELOAD): what was not flushed with fsync or fdatasync is gone.
 *
 * POWER_ROOT    the folder whose files are watched
 * POWER_DURABLE a folder in which this library keeps what is on the disk for certain:
 *               file-<inode>: content at its last flush; folder-<inode>: names and inodes at its last flush, a line each
 * POWER_CALL    the power fails before this call, counted from 1, of those that change or flush files; 0: never
 * At the end, or at the failure, POWER_DURABLE/calls has the number of calls.
 */
#define _GNU_SOURCE
#include <dirent.h>
#include <dlfcn.h>
#include <fcntl.h>
#include <pthread.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static pthread_mutex_t mutex = PTHREAD_MUTEX_INITIALIZER;
static const char *root, *durable;
static long last, calls;
static __thread int is_inside;

#define REAL(type, name, ...) static type (*real)(__VA_ARGS__); if (!real) *(void **)&real = dlsym(RTLD_NEXT, name)

static void name_of(char *path, size_t size, const char *kind, ino_t inode) {
    snprintf(path, size, "%s/%s-%lu", durable, kind, (unsigned long)inode);
}

/* Whether the open file is below the root. */
static int is_watched(int fd) {
    char link[64], path[4096];
    snprintf(link, sizeof link, "/proc/self/fd/%d", fd);
    ssize_t length = readlink(link, path, sizeof path - 1);
    if (length < 0 || !root) return 0;
    path[length] = 0;
    return strncmp(path, root, strlen(root)) == 0;
}

static void keep_file(const char *from, ino_t inode) {
    char to[4096], buffer[1 << 16];
    name_of(to, sizeof to, "file", inode);
    FILE *in = fopen(from, "rb"), *out = fopen(to, "wb");
    size_t count;
    while (in && out && (count = fread(buffer, 1, sizeof buffer, in)) > 0) fwrite(buffer, 1, count, out);
    if (in) fclose(in);
    if (out) fclose(out);
}

static void keep_folder(const char *path, ino_t inode, int is_deep) {
    char to[4096];
    name_of(to, sizeof to, "folder", inode);
    FILE *out = fopen(to, "w");
    DIR *folder = opendir(path);
    for (struct dirent *entry; folder && out && (entry = readdir(folder));) {
        char inner[8192];
        struct stat found;
        if (!strcmp(entry->d_name, ".") || !strcmp(entry->d_name, "..")) continue;
        snprintf(inner, sizeof inner, "%s/%s", path, entry->d_name);
        if (lstat(inner, &found)) continue;
        fprintf(out, "%lu %d %s\n", (unsigned long)found.st_ino, S_ISDIR(found.st_mode), entry->d_name);
        if (is_deep && S_ISDIR(found.st_mode)) keep_folder(inner, found.st_ino, 1);
        if (is_deep && S_ISREG(found.st_mode)) keep_file(inner, found.st_ino);
    }
    if (folder) closedir(folder);
    if (out) fclose(out);
}

static void say_calls(void) {
    char path[4096];
    snprintf(path, sizeof path, "%s/calls", durable);
    FILE *out = fopen(path, "w");
    if (out) fprintf(out, "%ld", calls), fclose(out);
}

__attribute__((constructor)) static void start(void) {
    struct stat found;
    is_inside = 1;
    root = getenv("POWER_ROOT");
    durable = getenv("POWER_DURABLE");
    const char *call = getenv("POWER_CALL");
    last = call ? atol(call) : 0;
    if (root && durable && !stat(root, &found)) keep_folder(root, found.st_ino, 1);
    is_inside = 0;
}

__attribute__((destructor)) static void end(void) {
    is_inside = 1;
    if (durable) say_calls();
}

/* Counts a call; at the last one the power fails. */
static void count(void) {
    if (is_inside || !durable) return;
    pthread_mutex_lock(&mutex);
    is_inside = 1;
    calls++;
    if (last && calls >= last) {
        say_calls();
        _exit(137);
    }
    is_inside = 0;
    pthread_mutex_unlock(&mutex);
}

static int flushed(int fd) {
    struct stat found;
    if (is_inside || !durable || !is_watched(fd) || fstat(fd, &found)) return 0;
    char link[64], path[4096];
    snprintf(link, sizeof link, "/proc/self/fd/%d", fd);
    ssize_t length = readlink(link, path, sizeof path - 1);
    if (length < 0) return 0;
    path[length] = 0;
    pthread_mutex_lock(&mutex);
    is_inside = 1;
    if (S_ISDIR(found.st_mode)) keep_folder(path, found.st_ino, 0);
    else keep_file(link, found.st_ino);
    is_inside = 0;
    pthread_mutex_unlock(&mutex);
    return 0;
}

/* A new file or folder: nothing of it is on the disk, whatever had its inode before. */
static void created(const char *kind, ino_t inode) {
    char path[4096];
    name_of(path, sizeof path, kind, inode);
    is_inside = 1;
    unlink(path);
    is_inside = 0;
}

static int opened(int fd, int flags) {
    struct stat found;
    if (fd >= 0 && (flags & O_CREAT) && (flags & O_EXCL) && !is_inside && durable && is_watched(fd) && !fstat(fd, &found))
        created("file", found.st_ino);
    return fd;
}

#define MODE(flags) mode_t mode = 0; if ((flags) & (O_CREAT | O_TMPFILE)) { va_list list; va_start(list, flags); mode = va_arg(list, mode_t); va_end(list); }

int open64(const char *path, int flags, ...) {
    MODE(flags)
    REAL(int, "open64", const char *, int, ...);
    if (flags & O_CREAT) count();
    return opened(real(path, flags, mode), flags);
}

int open(const char *path, int flags, ...) {
    MODE(flags)
    REAL(int, "open", const char *, int, ...);
    if (flags & O_CREAT) count();
    return opened(real(path, flags, mode), flags);
}

ssize_t write(int fd, const void *bytes, size_t size) {
    REAL(ssize_t, "write", int, const void *, size_t);
    if (!is_inside && fd > 2 && is_watched(fd)) count();
    return real(fd, bytes, size);
}

int fsync(int fd) {
    REAL(int, "fsync", int);
    count();
    int ended = real(fd);
    return ended ? ended : flushed(fd);
}

int fdatasync(int fd) {
    REAL(int, "fdatasync", int);
    count();
    int ended = real(fd);
    return ended ? ended : flushed(fd);
}

int rename(const char *from, const char *to) {
    REAL(int, "rename", const char *, const char *);
    count();
    return real(from, to);
}

int unlink(const char *path) {
    REAL(int, "unlink", const char *);
    count();
    return real(path);
}

int rmdir(const char *path) {
    REAL(int, "rmdir", const char *);
    count();
    return real(path);
}

int mkdir(const char *path, mode_t mode) {
    REAL(int, "mkdir", const char *, mode_t);
    count();
    int ended = real(path, mode);
    struct stat found;
    if (!ended && !is_inside && durable && !stat(path, &found)) created("folder", found.st_ino);
    return ended;
}

int ftruncate64(int fd, off64_t length) {
    REAL(int, "ftruncate64", int, off64_t);
    count();
    return real(fd, length);
}
