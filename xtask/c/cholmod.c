/* Factorises a symmetric matrix and solves with it by CHOLMOD, on command, for `cargo xtask bench --beside cholmod`.
 *
 * Argument: a directory with the lower triangle by columns (column-starts.i32, rows.i32, values.f64) and a right-hand side
 * (force.f64), little-endian. Reads commands line by line and answers each with one line:
 *   hello      version, ordering and entries of the factor as counted by the analysis
 *   factorise  CPU time (s) of one numeric factorisation
 *   solve      CPU time (s) of one solution
 *   solution   "written", with the last solution in solution.f64
 */
#include <cholmod.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

static const char *directory;

static FILE *opened(const char *name, const char *mode) {
    char path[4096];
    snprintf(path, sizeof path, "%s/%s", directory, name);
    FILE *file = fopen(path, mode);
    if (!file) {
        perror(path);
        exit(1);
    }
    return file;
}

static void *contents(const char *name, size_t *bytes) {
    FILE *file = opened(name, "rb");
    fseek(file, 0, SEEK_END);
    *bytes = (size_t)ftell(file);
    rewind(file);
    void *data = malloc(*bytes + 1);
    if (!data || fread(data, 1, *bytes, file) != *bytes) {
        fprintf(stderr, "%s cannot be read\n", name);
        exit(1);
    }
    fclose(file);
    return data;
}

static double cpu_time(void) {
    struct timespec time;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return time.tv_sec + 1e-9 * time.tv_nsec;
}

int main(int count, char **arguments) {
    if (count != 2) {
        fprintf(stderr, "expected one directory\n");
        return 2;
    }
    directory = arguments[1];
    size_t starts_bytes, rows_bytes, values_bytes, force_bytes;
    void *starts = contents("column-starts.i32", &starts_bytes);
    void *rows = contents("rows.i32", &rows_bytes);
    void *values = contents("values.f64", &values_bytes);
    void *force = contents("force.f64", &force_bytes);
    size_t n = starts_bytes / sizeof(int) - 1, entries = rows_bytes / sizeof(int);

    cholmod_common common;
    cholmod_start(&common);
    cholmod_sparse *matrix = cholmod_allocate_sparse(n, n, entries, 1, 1, -1, CHOLMOD_REAL, &common);
    cholmod_dense *load = cholmod_allocate_dense(n, 1, n, CHOLMOD_REAL, &common);
    memcpy(matrix->p, starts, starts_bytes);
    memcpy(matrix->i, rows, rows_bytes);
    memcpy(matrix->x, values, values_bytes);
    memcpy(load->x, force, force_bytes);

    /* Its default tries METIS only where AMD fills in much; the better of both is harder to beat. */
    common.nmethods = 2;
    common.method[0].ordering = CHOLMOD_AMD;
    common.method[1].ordering = CHOLMOD_METIS;
    common.postorder = 1;
    cholmod_factor *factor = cholmod_analyze(matrix, &common);
    if (!factor) {
        fprintf(stderr, "CHOLMOD cannot analyse the matrix\n");
        return 1;
    }
    const char *ordering = factor->ordering == CHOLMOD_METIS ? "METIS" : "AMD";
    double filled = common.lnz;

    cholmod_dense *solution = NULL, *work = NULL, *more_work = NULL;
    char command[64];
    while (fgets(command, sizeof command, stdin)) {
        double begin = cpu_time();
        if (!strcmp(command, "hello\n")) {
            printf("CHOLMOD %d.%d.%d, %s; %.0f\n", CHOLMOD_MAIN_VERSION, CHOLMOD_SUB_VERSION, CHOLMOD_SUBSUB_VERSION,
                   ordering, filled);
        } else if (!strcmp(command, "factorise\n")) {
            if (!cholmod_factorize(matrix, factor, &common) || factor->minor < n) {
                fprintf(stderr, "CHOLMOD cannot factorise the matrix\n");
                return 1;
            }
            printf("%.9g\n", cpu_time() - begin);
        } else if (!strcmp(command, "solve\n")) {
            if (!cholmod_solve2(CHOLMOD_A, factor, load, NULL, &solution, NULL, &work, &more_work, &common)) {
                fprintf(stderr, "CHOLMOD cannot solve\n");
                return 1;
            }
            printf("%.9g\n", cpu_time() - begin);
        } else if (!strcmp(command, "solution\n") && solution) {
            FILE *file = opened("solution.f64", "wb");
            int whole = fwrite(solution->x, sizeof(double), n, file) == n;
            if (fclose(file) || !whole) {
                fprintf(stderr, "solution.f64 cannot be written\n");
                return 1;
            }
            printf("written\n");
        } else {
            fprintf(stderr, "unknown command\n");
            return 2;
        }
        fflush(stdout);
    }
    return 0;
}
