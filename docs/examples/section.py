#!/usr/bin/env python3
"""section.py D.nii.gz L.nii.gz P.ppm: the middle layer of two volumes of `corcast coverage`. On the left, the distance
from the nearest vessel, dark far from vessels; on the right, the territories, with a line between two of them. Vessels
are dark red. Needs python3-nibabel."""
import sys
import nibabel
import numpy

distances, territories, picture = sys.argv[1:]
distance = numpy.asarray(nibabel.load(distances).dataobj)
label = numpy.asarray(nibabel.load(territories).dataobj)
middle = distance.shape[2] // 2
distance, label = distance[:, :, middle], label[:, :, middle]

def paint(colors):
    colors[distance == 0] = 0.45, 0.05, 0.08
    colors[numpy.isnan(distance)] = 1
    return colors

near = 1 - (distance / numpy.nanmax(distance))[:, :, None]
far, close = numpy.array([0.1, 0.15, 0.35]), numpy.array([1, 0.93, 0.8])
left = paint(far + near ** 1.5 * (close - far))

random = numpy.random.default_rng(5).random((label.max() + 1, 1))
right = 0.68 + 0.2 * numpy.cos(2 * numpy.pi * (random + numpy.array([0, 0.33, 0.67])))[label]
edge = numpy.zeros(label.shape, bool)
edge[1:] |= label[1:] != label[:-1]
edge[:, 1:] |= label[:, 1:] != label[:, :-1]
right[edge] = 1
right = paint(right)

panels = numpy.concatenate([left, numpy.ones((len(left) // 20, left.shape[1], 3)), right])
pixels = (255 * numpy.clip(panels, 0, 1).transpose(1, 0, 2)[::-1] + 0.5).astype(numpy.uint8)
with open(picture, "wb") as file:
    file.write(b"P6\n%d %d\n255\n" % pixels.shape[1::-1] + pixels.tobytes())
