"""Marks the wheel as one for a platform, and for every Python 3: its library is loaded by ctypes."""
import os

from setuptools import setup
from setuptools.dist import Distribution
from wheel.bdist_wheel import bdist_wheel


class PlatformDistribution(Distribution):
    """A distribution that has compiled code."""

    def has_ext_modules(self):
        return True


class PlatformWheel(bdist_wheel):
    """A wheel whose tag names the platform and its glibc alone."""

    def get_tag(self):
        glibc = os.confstr("CS_GNU_LIBC_VERSION").split()[1].replace(".", "_")
        return "py3", "none", super().get_tag()[2].replace("linux_", f"manylinux_{glibc}_")


setup(distclass=PlatformDistribution, cmdclass={"bdist_wheel": PlatformWheel})
