// SPDX-License-Identifier: Apache-2.0
#define _POSIX_C_SOURCE 200809L
#include "outfile.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static bool complain(const char *path, int error)
{
    fprintf(stderr, "occlude-bench: %s: %s\n", path, strerror(error));
    return false;
}

static void forget(outfile *file)
{
    free(file->path);
    free(file->temporary);
    *file = (outfile){0};
}

// Renaming over /dev/null or a pipe would replace it by a plain file.
static bool is_special(const char *path)
{
    struct stat status;
    return stat(path, &status) == 0 && !S_ISREG(status.st_mode);
}

static char *temporary_name(const char *path)
{
    size_t size = strlen(path) + 32;
    char *name = malloc(size);
    if (name) snprintf(name, size, "%s.%ld.part", path, (long)getpid());
    return name;
}

bool outfile_open(outfile *file, const char *path)
{
    *file = (outfile){0};
    file->path = strdup(path);
    bool special = is_special(path);
    if (!special) file->temporary = temporary_name(path);
    if (!file->path || (!special && !file->temporary)) {
        forget(file);
        return complain(path, ENOMEM);
    }
    file->stream = fopen(special ? path : file->temporary, "wb");
    if (file->stream) return true;
    int error = errno;
    forget(file);
    return complain(path, error);
}

bool outfile_commit(outfile *file)
{
    int error = ferror(file->stream) ? EIO : 0;
    errno = 0;
    if (fclose(file->stream) != 0 && error == 0) error = errno ? errno : EIO;
    if (error == 0 && file->temporary && rename(file->temporary, file->path) != 0) error = errno;
    if (error != 0) {
        complain(file->path, error);
        if (file->temporary) remove(file->temporary);
    }
    forget(file);
    return error == 0;
}

void outfile_abandon(outfile *file)
{
    if (!file->stream) return;
    fclose(file->stream);
    if (file->temporary) remove(file->temporary);
    forget(file);
}
