/* A plain bucket-queue A*: the yardstick for the compiled search. Built by the benchmark (gcc -O3), never shipped.
 *
 * Uniform grid, 8- or 26-connected, no corner cutting; the moves allowed from each cell are computed once per grid,
 * states of earlier queries are told apart by a query number, buckets are linked lists in one pool. */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

typedef struct { double g; uint32_t query, move; } Cell;
typedef struct { double g; uint32_t node; int32_t next; } Entry;
typedef struct {
    int nx, ny, nz, moves, offset[26], step[26][3];
    double length[26];
    int64_t size, room;
    int64_t buckets;
    uint32_t query;
    uint32_t *allowed;
    Cell *cells;
    Entry *pool;
    int32_t *head;
} Grid;

static double octile(int a, int b, int c) {
    int t;
    a = abs(a), b = abs(b), c = abs(c);
    if (a < b) t = a, a = b, b = t;
    if (b < c) t = b, b = c, c = t;
    if (a < b) t = a, a = b, b = t;
    return a + (sqrt(2) - 1) * b + (sqrt(3) - sqrt(2)) * c;
}

/* free_cells is padded with blocked cells on all sides (in 2D, nz == 1, sideways only). */
Grid *grid_new(const uint8_t *free_cells, int nz, int ny, int nx) {
    Grid *grid = calloc(1, sizeof *grid);
    grid->nx = nx, grid->ny = ny, grid->nz = nz, grid->size = (int64_t)nx * ny * nz;
    grid->cells = calloc(grid->size, sizeof(Cell));
    grid->allowed = calloc(grid->size, 4);
    grid->room = 1 << 16, grid->pool = malloc(grid->room * sizeof(Entry));
    grid->buckets = 1 << 16, grid->head = malloc(grid->buckets * 4);
    for (int z = -1; z <= 1; z++)
        for (int y = -1; y <= 1; y++)
            for (int x = -1; x <= 1; x++) {
                int kind = abs(x) + abs(y) + abs(z), k = grid->moves;
                if (!kind || (nz == 1 && z)) continue;
                grid->offset[k] = (z * ny + y) * nx + x;
                grid->length[k] = sqrt(kind);
                grid->step[k][0] = z, grid->step[k][1] = y, grid->step[k][2] = x;
                grid->moves++;
            }
    for (int64_t v = 0; v < grid->size; v++)
        for (int k = 0; free_cells[v] && k < grid->moves; k++) {
            int ok = 1, *s = grid->step[k];
            for (int z = 0; z <= (s[0] != 0); z++)
                for (int y = 0; y <= (s[1] != 0); y++)
                    for (int x = 0; x <= (s[2] != 0); x++)
                        ok &= free_cells[v + ((int64_t)z * s[0] * ny + y * s[1]) * nx + x * s[2]];
            if (ok) grid->allowed[v] |= 1u << k;
        }
    return grid;
}

void grid_free(Grid *grid) {
    free(grid->cells), free(grid->allowed), free(grid->pool), free(grid->head), free(grid);
}

double grid_astar(Grid *grid, uint32_t start, uint32_t goal, double width) {
    int nx = grid->nx, ny = grid->ny, nxy = nx * ny;
    int gx = goal % nx, gy = goal / nx % ny, gz = goal / nxy;
    uint32_t query = ++grid->query;
    double best = INFINITY;
    double f0 = octile(start % nx - gx, start / nx % ny - gy, start / nxy - gz);
    int64_t last = 0, used = 1;
    grid->head[0] = 0;
    grid->pool[0] = (Entry){0, start, -1};
    grid->cells[start] = (Cell){0, query, 0};
    for (int64_t b = 0; b <= last; b++) {
        if (best <= f0 + b * width + 1e-9) break;
        while (grid->head[b] >= 0) {
            Entry entry = grid->pool[grid->head[b]];
            Cell *cell = grid->cells + entry.node;
            grid->head[b] = entry.next;
            if (cell->g != entry.g || cell->move & 128) continue;
            cell->move |= 128;
            if (entry.node == goal) {
                best = entry.g;
                continue;
            }
            int x = entry.node % nx, y = entry.node / nx % ny, z = entry.node / nxy;
            for (uint32_t word = grid->allowed[entry.node]; word; word &= word - 1) {
                int k = __builtin_ctz(word);
                uint32_t to = entry.node + grid->offset[k];
                double g = entry.g + grid->length[k];
                Cell *next = grid->cells + to;
                if (next->query == query && g >= next->g - 1e-12) continue;
                double f = g + octile(x + grid->step[k][2] - gx, y + grid->step[k][1] - gy, z + grid->step[k][0] - gz);
                if (f >= best) continue;
                *next = (Cell){g, query, k};
                int64_t q = (int64_t)((f - f0) / width);
                if (q < b) q = b;
                if (q >= grid->buckets) {
                    while (q >= grid->buckets) grid->buckets *= 2;
                    grid->head = realloc(grid->head, grid->buckets * 4);
                }
                while (last < q) grid->head[++last] = -1;
                if (used == grid->room) grid->pool = realloc(grid->pool, (grid->room *= 2) * sizeof(Entry));
                grid->pool[used] = (Entry){g, to, grid->head[q]};
                grid->head[q] = used++;
            }
        }
    }
    return best;
}
