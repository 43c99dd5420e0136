#!/usr/bin/env python3
"""project.py V.nii.gz P.ppm: the volume from the front. On the left, the largest part that vessels fill of a voxel on
each line along z, a maximum intensity projection; on the right, the same, in a color for each label of
V.labels.nii.gz. Needs python3-nibabel."""
import sys
import nibabel
import numpy

path, picture = sys.argv[1:]
filled = nibabel.load(path).get_fdata(dtype=numpy.float32)
labels = numpy.asarray(nibabel.load(path.replace(".nii.gz", ".labels.nii.gz")).dataobj)

fullest = filled.argmax(axis=2)[:, :, None]
projection = numpy.take_along_axis(filled, fullest, axis=2)
label = numpy.take_along_axis(labels, fullest, axis=2)[:, :, 0]
colors = 0.1 + 0.9 * numpy.random.default_rng(7).random((labels.max() + 1, 3))

panels = numpy.concatenate([projection * numpy.ones(3), projection * colors[label]])
pixels = (255 * panels.transpose(1, 0, 2)[::-1] + 0.5).astype(numpy.uint8)
with open(picture, "wb") as file:
    file.write(b"P6\n%d %d\n255\n" % pixels.shape[1::-1] + pixels.tobytes())
