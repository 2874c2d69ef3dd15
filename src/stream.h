// SPDX-License-Identifier: Apache-2.0
// Items of work that one thread offers while others already do them. What an item does is a
// function of the item alone, so neither the number of threads nor their pace can show.
#ifndef OCC_STREAM_H
#define OCC_STREAM_H

#include <stdbool.h>
#include <stdint.h>

typedef struct occ_stream occ_stream;

// Runs make(stream, context) in this thread, and work(context, i) for every item offered, in this
// and up to `threads` - 1 others, in any order. Returns when all items are done.
void occ_with_stream(uint32_t threads, void (*make)(occ_stream *stream, void *context),
                     void (*work)(void *context, uint32_t item), void *context);

// Says that items below `count` may be done. NULL is accepted, as below.
void occ_stream_offer(occ_stream *stream, uint32_t count);

// Waits until nothing is being done: what work() reads may be changed until the next offer.
void occ_stream_pause(occ_stream *stream);

#endif
