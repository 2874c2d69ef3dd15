// SPDX-License-Identifier: Apache-2.0
/// @file
/// Instances: what was found for a mesh once, carried to each place where the mesh stands.
///
/// A mesh that is placed many times is split, bounded and searched for inner boxes once, in its own
/// coordinates. Carrying a box through a model matrix rounds it, though, and whoever places the
/// vertices rounds them too. So the calls below get the vertices where they will be, as floats, and
/// what they return is true of these: it is proven anew, not derived.
///
/// `placed` is the mesh as it stands in the world: the same triangles in the same order. `model` is
/// the matrix that led there, as occ_box_from_model() takes it; how exactly it did does not matter.
///
/// Fails as the calls of soup.h and inner.h do.
#ifndef OCCLUDE_INSTANCES_H
#define OCCLUDE_INSTANCES_H

#include "inner.h"

/// The bounds of an instance, from bounds of its mesh: turned as these are turned by the matrix, or
/// along the axes if that is as small. Their sides are fitted to the vertices of `placed` anew, so
/// that every one is inside, exactly. Much quicker than occ_bounds_of_soup(), which is called where
/// the matrix does not keep right angles.
OCC_API OCC_NODISCARD occ_result occ_bounds_of_instance(const occ_soup *placed, const float *model,
                                                        const occ_box *bounds,
                                                        const occ_soup_work *work, occ_box *box);

/// The inner boxes of an instance, from `count` inner boxes of its mesh: those that
/// occ_verify_inner() accepts for `placed` with this desc, `max_hole` being 0. A box that rounding
/// has moved into a triangle is made smaller by a few units in the last place of its coordinates;
/// one that does not get accepted so is left out. `carried` has room for `count` boxes and receives
/// `*carried_count`, in their order, without a grid. It may be `boxes`.
OCC_API OCC_NODISCARD occ_result occ_inner_of_instance(const occ_soup *placed, const float *model,
                                                       const occ_inner_box *boxes, size_t count,
                                                       const occ_inner_desc *desc,
                                                       occ_inner_box *carried,
                                                       size_t *carried_count);

#endif
