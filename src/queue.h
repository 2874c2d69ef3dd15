// SPDX-License-Identifier: Apache-2.0
// What the walk is yet to look at, roughly nearest first: a bucket queue (Dial, Algorithm 360,
// Communications of the ACM 12, 1969). A bucket is a sixteenth of an octave of distance squared
// wide, so that taking and adding cost the same however much is waiting.
#ifndef OCC_QUEUE_H
#define OCC_QUEUE_H

#include "memory.h"

#include <math.h>
#include <string.h>

// A node or an occluder that is still to be looked at.
typedef struct occ_walk_entry {
    float key;      // how near it is; nothing below a node is nearer
    uint32_t index; // of the node, or row of the occluder
    uint32_t what;  // OCC_WALK_*; and the frustum planes that may cut the node, or how many
                    // occluders are known not to hide the occluder
    uint32_t next;  // behind it in its bucket, or OCC_QUEUE_END
} occ_walk_entry;

#define OCC_WALK_NODE     0x00000000u // of the objects
#define OCC_WALK_FREE     0x40000000u // a node of the occluders that nobody owns
#define OCC_WALK_OCCLUDER 0x80000000u
#define OCC_WALK_PLANES   0x0000ffffu
#define OCC_WALK_ASKED    0x3fffffffu

#define OCC_QUEUE_END     0xffffffffu
#define OCC_QUEUE_STEPS   16u // buckets to an octave
#define OCC_QUEUE_OCTAVES 40u // what is nearer than these below the farthest shares the first
#define OCC_QUEUE_BUCKETS (OCC_QUEUE_STEPS * OCC_QUEUE_OCTAVES)
#define OCC_QUEUE_SHIFT   19u // from the bits of a float to octaves times steps

// Of each bucket two lists: occluders go before nodes.
#define OCC_QUEUE_LISTS (2u * OCC_QUEUE_BUCKETS)

typedef struct occ_queue {
    occ_array entries;              // of occ_walk_entry, in any order
    uint32_t unused;                // a list of those that were taken
    uint32_t count;                 // how many wait
    uint32_t lowest;                // no word before this one has a bit
    int32_t base;                   // of the first bucket
    float origin;                   // keys count from here
    uint32_t head[OCC_QUEUE_LISTS]; // where the bit is set
    uint64_t used[OCC_QUEUE_LISTS / 64];
} occ_queue;

// Empties it. Keys will be from `nearest` to about `farthest`; others are kept in the outer
// buckets, right but not in order.
static inline void occ_queue_start(occ_queue *queue, float nearest, float farthest)
{
    float span = farthest - nearest;
    uint32_t bits;
    memcpy(&bits, &span, sizeof bits);
    queue->entries.count = queue->count = 0;
    queue->unused = OCC_QUEUE_END;
    queue->lowest = OCC_QUEUE_LISTS / 64;
    queue->base = (int32_t)(bits >> OCC_QUEUE_SHIFT) + 2 - (int32_t)OCC_QUEUE_BUCKETS;
    queue->origin = nearest;
    memset(queue->used, 0, sizeof queue->used);
}

// The bucket of a key.
static inline uint32_t occ_queue_bucket(const occ_queue *queue, float key)
{
    float above = key - queue->origin;
    if (!(above > 0.0f)) return 0;
    uint32_t bits;
    memcpy(&bits, &above, sizeof bits);
    int32_t bucket = (int32_t)(bits >> OCC_QUEUE_SHIFT) - queue->base;
    if (bucket < 0) return 0;
    return bucket < (int32_t)OCC_QUEUE_BUCKETS ? (uint32_t)bucket : OCC_QUEUE_BUCKETS - 1;
}

// The list of the nearest that waits. There is one.
static inline uint32_t occ_queue_first(const occ_queue *queue)
{
    uint32_t word = queue->lowest;
    while (!queue->used[word])
        word++;
    return 64u * word + (uint32_t)__builtin_ctzll(queue->used[word]);
}

static inline uint32_t occ_queue_bucket_of_first(const occ_queue *queue)
{
    return occ_queue_first(queue) / 2;
}

static inline occ_walk_entry occ_queue_pop(occ_queue *queue)
{
    uint32_t list = occ_queue_first(queue), place = queue->head[list];
    occ_walk_entry *entry = (occ_walk_entry *)queue->entries.data + place, taken = *entry;
    queue->lowest = list / 64;
    queue->head[list] = taken.next;
    if (taken.next == OCC_QUEUE_END) queue->used[list / 64] &= ~(1ull << list % 64);
    entry->next = queue->unused;
    queue->unused = place;
    queue->count--;
    return taken;
}

static inline occ_result occ_queue_push(occ_hooks *hooks, occ_queue *queue, occ_walk_entry entry)
{
    uint32_t place = queue->unused, list = 2 * occ_queue_bucket(queue, entry.key);
    if (!(entry.what & OCC_WALK_OCCLUDER)) list++;
    occ_walk_entry *at;
    if (place == OCC_QUEUE_END) {
        place = queue->entries.count;
        at = occ_array_push(hooks, &queue->entries);
        if (!at) return OCC_ERROR_OUT_OF_MEMORY;
    } else {
        at = (occ_walk_entry *)queue->entries.data + place;
        queue->unused = at->next;
    }
    uint64_t bit = 1ull << list % 64;
    entry.next = queue->used[list / 64] & bit ? queue->head[list] : OCC_QUEUE_END;
    *at = entry;
    queue->head[list] = place;
    queue->used[list / 64] |= bit;
    if (list / 64 < queue->lowest) queue->lowest = list / 64;
    queue->count++;
    return OCC_SUCCESS;
}

#endif
