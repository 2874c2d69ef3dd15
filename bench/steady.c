// SPDX-License-Identifier: Apache-2.0
// splitmix64: Steele, Lea, Flood, "Fast splittable pseudorandom number generators" (2014).
#include "steady.h"

#include <math.h>
#include <stdbool.h>

uint64_t steady_bits(steady_random *random)
{
    uint64_t z = random->state += UINT64_C(0x9e3779b97f4a7c15);
    z = (z ^ z >> 30) * UINT64_C(0xbf58476d1ce4e5b9);
    z = (z ^ z >> 27) * UINT64_C(0x94d049bb133111eb);
    return z ^ z >> 31;
}

steady_random steady_seed(uint64_t seed, const char *label)
{
    steady_random random = {seed};
    for (; *label; label++)
        random.state = steady_bits(&random) ^ (uint8_t)*label;
    return random;
}

double steady_unit(steady_random *random)
{
    return (double)(steady_bits(random) >> 11) * 0x1p-53;
}

double steady_between(steady_random *random, double low, double high)
{
    return low + (high - low) * steady_unit(random);
}

uint32_t steady_below(steady_random *random, uint32_t count)
{
    return (uint32_t)(steady_unit(random) * count);
}

// Taylor series about 0, for |r| <= pi / 4: the first term left out is below 1e-17.
static double sine_series(double r)
{
    double square = r * r, sum = 0;
    for (int k = 17; k >= 3; k -= 2)
        sum = (1 + sum) * (-square / (k * (k - 1)));
    return r + r * sum;
}

static double cosine_series(double r)
{
    double square = r * r, sum = 0;
    for (int k = 18; k >= 2; k -= 2)
        sum = (1 + sum) * (-square / (k * (k - 1)));
    return 1 + sum;
}

// x less a multiple of pi / 2, which is kept in two parts so that the product is exact.
static double reduce(double x, double *quarter_turns)
{
    double n = floor(x * 0.63661977236758134308 + 0.5);
    *quarter_turns = n - 4 * floor(n / 4);
    return (x - n * 0x1.921fb544p+0) - n * 0x1.0b4611a626331p-34;
}

double steady_sin(double x)
{
    double quarter_turns, r = reduce(x, &quarter_turns);
    double value = quarter_turns == 1 || quarter_turns == 3 ? cosine_series(r) : sine_series(r);
    return quarter_turns >= 2 ? -value : value;
}

double steady_cos(double x)
{
    double quarter_turns, r = reduce(x, &quarter_turns);
    bool odd = quarter_turns == 1 || quarter_turns == 3;
    double value = odd ? sine_series(r) : cosine_series(r);
    return quarter_turns == 1 || quarter_turns == 2 ? -value : value;
}

double steady_exp(double x)
{
    double n = floor(x * 1.4426950408889634074 + 0.5);
    double r = (x - n * 0x1.62e42feep-1) - n * 0x1.a39ef35793c76p-33;
    double sum = 1;
    for (int k = 16; k >= 1; k--)
        sum = 1 + sum * r / k;
    return ldexp(sum, (int)n);
}

// x is 2^n m with m next to 1, and log m = 2 artanh((m - 1) / (m + 1)).
double steady_log(double x)
{
    int n;
    double m = frexp(x, &n);
    if (m < 0.70710678118654752440) {
        m *= 2;
        n--;
    }
    double part = (m - 1) / (m + 1), square = part * part, sum = 0;
    for (int k = 23; k >= 1; k -= 2)
        sum = sum * square + 1.0 / k;
    return 2 * part * sum + n * 0x1.a39ef35793c76p-33 + n * 0x1.62e42feep-1;
}

double steady_cbrt(double x)
{
    if (!(x > 0)) return 0;
    double root = 1;
    while (root * root * root < x)
        root *= 2;
    for (int i = 0; i < 64; i++) { // Newton, from above: strictly falling until it has converged
        double next = (2 * root + x / (root * root)) / 3;
        if (!(next < root)) break;
        root = next;
    }
    return root;
}
