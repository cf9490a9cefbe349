/* SPDX-License-Identifier: BSD-3-Clause */
/* Tensors with a halo: layout, views, copies. */
#include <string.h>

#include "kernel/kernel.h"

#define LINE 16   /* floats in 64 bytes */
#define PAGE 1024 /* floats in 4 KiB */

ptie_map ptie_map_make(int32_t channels, int32_t height, int32_t width) {
    /* One zero column is right halo of its row and left halo of the next. */
    ptrdiff_t row = ((ptrdiff_t)width + 1 + LINE - 1) / LINE * LINE;
    ptrdiff_t plane = ((ptrdiff_t)height + 2) * row;
    if (plane % PAGE == 0) plane += LINE;
    return (ptie_map){
        .channels = channels, .height = height, .width = width, .row = row, .plane = plane};
}

/* Floats before pixel (0, 0): the top halo row, and the corner to its left. */
static ptrdiff_t lead(const ptie_map *map) {
    return map->row + LINE;
}

size_t ptie_map_floats(const ptie_map *map) {
    return (size_t)lead(map) + (size_t)map->channels * (size_t)map->plane + PTIE_MAP_OVERREAD;
}

ptie_map ptie_map_in(ptie_map map, float *block) {
    map.data = block + lead(&map);
    return map;
}

ptie_map ptie_map_channels(ptie_map map, int32_t first, int32_t count) {
    map.data += first * map.plane;
    map.channels = count;
    return map;
}

ptie_map ptie_map_rows(ptie_map map, int32_t first, int32_t count) {
    map.data += first * map.row;
    map.height = count;
    return map;
}

void ptie_map_load(const ptie_map *map, const float *image) {
    for (int32_t c = 0; c < map->channels; c++)
        for (int32_t y = 0; y < map->height; y++, image += map->width)
            memcpy(map->data + c * map->plane + y * map->row, image,
                   (size_t)map->width * sizeof *image);
}

void ptie_map_store(float *image, const ptie_map *map) {
    for (int32_t c = 0; c < map->channels; c++)
        for (int32_t y = 0; y < map->height; y++, image += map->width)
            memcpy(image, map->data + c * map->plane + y * map->row,
                   (size_t)map->width * sizeof *image);
}

void ptie_map_clear_halo(const ptie_map *map) {
    const size_t row = (size_t)map->row, width = (size_t)map->width;
    for (int32_t c = 0; c < map->channels; c++) {
        float *plane = map->data + c * map->plane;
        memset(plane - row - 1, 0, (row + 1) * sizeof *plane);
        for (int32_t y = 0; y < map->height; y++)
            memset(plane + y * map->row + width, 0, (row - width) * sizeof *plane);
        memset(plane + map->height * map->row, 0, row * sizeof *plane);
    }
}
