// SPDX-License-Identifier: Apache-2.0
// Runs a fuzz target over a corpus without libFuzzer: replay DIRECTORY...
//
// Each input comes in a buffer of exactly its size, so that AddressSanitizer sees one byte read too
// many; and not only the input itself but also beginnings of it, which is how files get damaged.

#define _POSIX_C_SOURCE 200809L

#include <dirent.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

enum { MAX_CUTS = 64 };

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void run_cut(const uint8_t *data, size_t size)
{
    uint8_t *exact = malloc(size > 0 ? size : 1);
    if (exact == NULL) {
        fprintf(stderr, "replay: out of memory\n");
        exit(EXIT_FAILURE);
    }
    memcpy(exact, data, size);
    LLVMFuzzerTestOneInput(exact, size);
    free(exact);
}

static uint8_t *read_file(const char *path, size_t *size)
{
    FILE *file = fopen(path, "rb");
    struct stat status;
    if (file == NULL || fstat(fileno(file), &status) != 0) {
        perror(path);
        exit(EXIT_FAILURE);
    }
    *size = (size_t)status.st_size;
    uint8_t *data = malloc(*size + 1);
    if (data == NULL || fread(data, 1, *size, file) != *size) {
        fprintf(stderr, "%s: cannot be read\n", path);
        exit(EXIT_FAILURE);
    }
    fclose(file);
    return data;
}

static void run_file(const char *path)
{
    size_t size = 0;
    uint8_t *data = read_file(path, &size);
    size_t step = size / MAX_CUTS + 1;
    for (size_t cut = 0; cut < size; cut += step) {
        run_cut(data, cut);
    }
    run_cut(data, size);
    free(data);
}

static unsigned run_directory(const char *directory)
{
    DIR *listing = opendir(directory);
    if (listing == NULL) {
        perror(directory);
        exit(EXIT_FAILURE);
    }
    unsigned files = 0;
    for (struct dirent *entry = readdir(listing); entry != NULL; entry = readdir(listing)) {
        char path[4096];
        if (entry->d_name[0] == '.' ||
            snprintf(path, sizeof path, "%s/%s", directory, entry->d_name) >= (int)sizeof path) {
            continue;
        }
        run_file(path);
        files++;
    }
    closedir(listing);
    return files;
}

int main(int argc, char **argv)
{
    unsigned files = 0;
    for (int i = 1; i < argc; i++) {
        files += run_directory(argv[i]);
    }
    printf("%u inputs\n", files);
    if (files == 0) {
        fprintf(stderr, "replay: an empty corpus tests nothing\n");
        return EXIT_FAILURE;
    }
    return EXIT_SUCCESS;
}
