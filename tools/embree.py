#!/usr/bin/env python3
"""Compares the ground truth with Embree, ray by ray; run by hand.

    pip install embreex numpy
    cargo run --release --example truth_export -- SCENE 100000 > rays.bin
    tools/embree.py rays.bin

Embree computes in f32. A disagreement is explained by one of these, else the run fails:
  edge     the ray passes an edge of a triangle that one of them hit within f32 error
  surface  both triangles lie at the ray within f32 error of each other
"""

import sys

import numpy as np
from embreex import rtcore_scene
from embreex.mesh_construction import TriangleMesh

# The bounds that docs/truth.md derives for our own test, in f32.
DISTANCE = 16 * np.finfo(np.float32).eps
EDGE = 4 * np.finfo(np.float32).eps
MISS = 2**32 - 1


def read(path):
    data = open(path, "rb").read()
    triangles, rays = np.frombuffer(data, "<u4", 2)
    floats = np.frombuffer(data, "<f4", 9 * triangles + 6 * rays, 8)
    hits = np.frombuffer(data, [("triangle", "<u4"), ("distance", "<f8")], rays, 8 + floats.nbytes)
    corners = floats[: 9 * triangles].reshape(-1, 3, 3)
    rays = floats[9 * triangles :].reshape(-1, 2, 3)
    return corners, rays[:, 0], rays[:, 1], hits["triangle"], hits["distance"]


def geometry(corners, origin, direction):
    """In f64, of a ray and a triangle: distance to the plane, cosine of incidence, distance from
    the ray to the nearest edge, whether the ray is inside, largest relative coordinate."""
    v = corners.astype(np.float64) - origin.astype(np.float64)[:, None]
    d = direction / np.linalg.norm(direction.astype(np.float64), axis=1)[:, None]
    normal = np.cross(v[:, 1] - v[:, 0], v[:, 2] - v[:, 0])
    normal /= np.maximum(np.linalg.norm(normal, axis=1), 1e-300)[:, None]
    cos = np.einsum("ij,ij->i", normal, d)
    with np.errstate(divide="ignore", invalid="ignore"):
        distance = np.einsum("ij,ij->i", normal, v[:, 0]) / cos
    across = v - np.einsum("ijk,ik->ij", v, d)[..., None] * d[:, None]
    sides = [(across[:, i], across[:, (i + 1) % 3]) for i in range(3)]
    edges = np.stack([segment(a, b) for a, b in sides])
    turns = np.stack([np.einsum("ij,ij->i", np.cross(a, b), d) for a, b in sides])
    inside = (turns > 0).all(axis=0) | (turns < 0).all(axis=0)
    return distance, np.abs(cos), edges.min(axis=0), inside, np.abs(v).max(axis=(1, 2))


def segment(a, b):
    """Distance of the origin from a segment."""
    span = b - a
    square = np.maximum(np.einsum("ij,ij->i", span, span), 1e-300)
    t = np.clip(-np.einsum("ij,ij->i", a, span) / square, 0, 1)
    return np.linalg.norm(a + t[:, None] * span, axis=1)


def main():
    corners, origin, direction, ours, our_distance = read(sys.argv[1])
    scene = rtcore_scene.EmbreeScene(robust=True)
    TriangleMesh(scene, np.ascontiguousarray(corners))
    rays = np.ascontiguousarray(origin), np.ascontiguousarray(direction)
    found = scene.run(*rays, query="INTERSECT", output=1)
    theirs = found["primID"].astype(np.int64)
    theirs[theirs < 0] = MISS
    length = np.linalg.norm(direction.astype(np.float64), axis=1)
    their_distance = np.where(theirs == MISS, np.inf, found["tfar"] * length)

    hit = [np.where(side == MISS, 0, side) for side in (ours, theirs)]
    (t0, cos0, edge0, inside0, reach0), (t1, cos1, edge1, inside1, reach1) = (
        geometry(corners[i], origin, direction) for i in hit
    )
    ours_at_edge = (ours != MISS) & (edge0 <= EDGE * reach0)
    theirs_at_edge = (theirs != MISS) & (edge1 <= EDGE * reach1)
    with np.errstate(divide="ignore", invalid="ignore"):
        bound0, bound1 = DISTANCE * reach0 / cos0, DISTANCE * reach1 / cos1
        near_surfaces = (ours != MISS) & (theirs != MISS) & inside0 & inside1
        near_surfaces &= np.abs(t0 - t1) <= bound0 + bound1
        near_surfaces &= np.abs(t0 - our_distance) <= bound0
        error = np.abs(our_distance - their_distance)
    same = ours == theirs
    both = same & (ours != MISS)
    too_far = both & ~(error <= bound0)
    counts = {"edge": 0, "surface": 0, "unexplained": 0}
    for i in np.flatnonzero(~same | too_far):
        if ~same[i] and (ours_at_edge[i] or theirs_at_edge[i]):
            reason = "edge"
        elif ~same[i] and near_surfaces[i]:
            reason = "surface"
        else:
            reason = "unexplained"
        counts[reason] += 1
        print(
            f"ray {i}: {reason}: triangle {ours[i]} at {our_distance[i]:.9g}, "
            f"Embree's {theirs[i]} at {their_distance[i]:.9g}; "
            f"to an edge {edge0[i]:.1e}, {edge1[i]:.1e}; cosines {cos0[i]:.1e}, {cos1[i]:.1e}"
        )
    print(
        f"{len(ours)} rays at {len(corners)} triangles: {both.sum()} hit the same triangle, "
        f"{(same & (ours == MISS)).sum()} hit nothing, {(~same).sum()} differ; "
        f"explained by an edge {counts['edge']}, by a near surface {counts['surface']}, "
        f"unexplained {counts['unexplained']}"
    )
    if both.any():
        share = (error[both] / bound0[both]).max()
        print(f"largest difference of distance {error[both].max():.2e}, {share:.3f} of its bound")
    sys.exit(counts["unexplained"] > 0)


if __name__ == "__main__":
    main()
