/* A disk without locks or shared memory, for files below a folder: preloaded into the process that is tested.

POOR_DISK names the folder; POOR_DISK_LACKS what does not work there: "records" (POSIX locks), "files" (flock),
"maps" (shared mappings), "speed" (every write waits for 3 ms), in any order.
*/
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

static int lacks(int fd, const char *what) {
    const char *folder = getenv("POOR_DISK"), *list = getenv("POOR_DISK_LACKS");
    char link[64], path[PATH_MAX];
    if (!folder || !list || !strstr(list, what) || fd < 0) return 0;
    snprintf(link, sizeof link, "/proc/self/fd/%d", fd);
    ssize_t n = readlink(link, path, sizeof path - 1);
    if (n < 0) return 0;
    path[n] = 0;
    return strncmp(path, folder, strlen(folder)) == 0;
}

static int is_lock(int command) {
    return command == F_SETLK || command == F_SETLKW || command == F_GETLK;
}

#define FCNTL(name)                                                        \
    int name(int fd, int command, ...) {                                   \
        va_list rest;                                                      \
        va_start(rest, command);                                           \
        void *argument = va_arg(rest, void *);                             \
        va_end(rest);                                                      \
        if (is_lock(command) && lacks(fd, "records")) {                    \
            errno = ENOLCK;                                                \
            return -1;                                                     \
        }                                                                  \
        int (*next)(int, int, ...) = dlsym(RTLD_NEXT, #name);              \
        return next(fd, command, argument);                                \
    }
FCNTL(fcntl)
FCNTL(fcntl64)

int flock(int fd, int operation) {
    if (lacks(fd, "files")) {
        errno = ENOLCK;
        return -1;
    }
    int (*next)(int, int) = dlsym(RTLD_NEXT, "flock");
    return next(fd, operation);
}

#define MMAP(name)                                                                     \
    void *name(void *at, size_t size, int protection, int flags, int fd, off_t from) { \
        if ((flags & MAP_SHARED) && lacks(fd, "maps")) {                               \
            errno = ENODEV;                                                            \
            return MAP_FAILED;                                                         \
        }                                                                              \
        void *(*next)(void *, size_t, int, int, int, off_t) = dlsym(RTLD_NEXT, #name); \
        return next(at, size, protection, flags, fd, from);                            \
    }
MMAP(mmap)
MMAP(mmap64)

#define PWRITE(name, offset)                                                       \
    ssize_t name(int fd, const void *from, size_t size, offset at) {               \
        if (lacks(fd, "speed")) usleep(3000);                                     \
        ssize_t (*next)(int, const void *, size_t, offset) = dlsym(RTLD_NEXT, #name); \
        return next(fd, from, size, at);                                           \
    }
PWRITE(pwrite, off_t)
PWRITE(pwrite64, off64_t)
