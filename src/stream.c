// SPDX-License-Identifier: Apache-2.0
#include "stream.h"

#include "team.h"

#include <stdatomic.h>
#include <stddef.h>

struct occ_stream {
    _Alignas(64) atomic_uint_least32_t offered;
    _Alignas(64) atomic_uint_least32_t taken;
    _Alignas(64) atomic_uint_least32_t done;
    atomic_bool complete; // nothing more will be offered
    void (*make)(occ_stream *stream, void *context);
    void (*work)(void *context, uint32_t item);
    void *context;
};

// Takes an item and does it. False if none is there.
static bool do_item(occ_stream *stream)
{
    uint32_t item = atomic_load_explicit(&stream->taken, memory_order_relaxed);
    do {
        if (item >= atomic_load_explicit(&stream->offered, memory_order_acquire)) return false;
    } while (!atomic_compare_exchange_weak_explicit(&stream->taken, &item, item + 1,
                                                    memory_order_relaxed, memory_order_relaxed));
    stream->work(stream->context, item);
    atomic_fetch_add_explicit(&stream->done, 1, memory_order_release);
    return true;
}

void occ_stream_offer(occ_stream *stream, uint32_t count)
{
    if (stream) atomic_store_explicit(&stream->offered, count, memory_order_release);
}

void occ_stream_pause(occ_stream *stream)
{
    if (!stream) return;
    uint32_t looks = 0, offered = atomic_load_explicit(&stream->offered, memory_order_relaxed);
    while (do_item(stream))
        ;
    while (atomic_load_explicit(&stream->done, memory_order_acquire) != offered)
        occ_wait_a_little(&looks);
}

static void take_items(void *context)
{
    occ_stream *stream = context;
    uint32_t looks = 0;
    while (!atomic_load_explicit(&stream->complete, memory_order_acquire))
        if (!do_item(stream)) occ_wait_a_little(&looks);
}

static void make_items(void *context)
{
    occ_stream *stream = context;
    stream->make(stream, stream->context);
    occ_stream_pause(stream);
    atomic_store_explicit(&stream->complete, true, memory_order_release);
}

void occ_with_stream(uint32_t threads, void (*make)(occ_stream *stream, void *context),
                     void (*work)(void *context, uint32_t item), void *context)
{
    occ_stream stream = {.make = make, .work = work, .context = context};
    occ_first_and_others(threads, make_items, take_items, &stream);
}
