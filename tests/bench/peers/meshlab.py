"""Scripts for meshlabserver, and the display that it needs though it draws nothing."""

import os
import subprocess
import time
from pathlib import Path

_NORMALS = """ <filter name="Compute normals for point sets">
  <Param name="K" type="RichInt" value="{neighbours}"/>
  <Param name="smoothIter" type="RichInt" value="0"/>
  <Param name="flipFlag" type="RichBool" value="false"/>
  <Param name="viewPos" type="RichPoint3f" x="0" y="0" z="0"/>
 </filter>
"""

_PROJECTION = """ <filter name="MLS projection ({name})">
  <Param name="ControlMesh" type="RichMesh" value="0"/>
  <Param name="ProxyMesh" type="RichMesh" value="0"/>
  <Param name="SelectionOnly" type="RichBool" value="false"/>
  <Param name="FilterScale" type="RichFloat" value="{scale}"/>
  <Param name="ProjectionAccuracy" type="RichFloat" value="0.0001"/>
  <Param name="MaxProjectionIters" type="RichInt" value="15"/>
{own}  <Param name="MaxSubdivisions" type="RichInt" value="0"/>
  <Param name="ThAngleInDegree" type="RichFloat" value="2"/>
 </filter>
"""

_OWN = {
    "APSS": """  <Param name="SphericalParameter" type="RichFloat" value="{sphericity}"/>
  <Param name="AccurateNormal" type="RichBool" value="true"/>
""",
    "RIMLS": """  <Param name="SigmaN" type="RichFloat" value="{sharpness}"/>
  <Param name="MaxRefittingIters" type="RichInt" value="3"/>
""",
}


def write_script(path, name, settings):
    """A script that estimates normals and projects the points onto their own MLS surface.

    @param name  "APSS" or "RIMLS"
    """
    projection = _PROJECTION.format(name=name, scale=settings["scale"],
                                    own=_OWN[name].format(**settings))
    Path(path).write_text("<!DOCTYPE FilterScript>\n<FilterScript>\n" +
                          _NORMALS.format(**settings) + projection + "</FilterScript>\n",
                          encoding="utf-8")


class Display:
    """An X server without a screen, as long as the `with` lasts."""

    def __enter__(self):
        read, write = os.pipe()
        self.process = subprocess.Popen(
            ["Xvfb", "-displayfd", str(write), "-screen", "0", "640x480x24", "-nolisten", "tcp"],
            pass_fds=[write], stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL)
        os.close(write)
        with os.fdopen(read) as number:
            os.environ["DISPLAY"] = ":" + number.readline().strip()
        time.sleep(0.5)
        return self

    def __exit__(self, *_):
        self.process.terminate()
        self.process.wait()
