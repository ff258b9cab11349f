"""Where the encoder of MP4 is on this machine."""

import shutil
from importlib.util import find_spec

from meshwind.core.errors import BadInputError


def encoder() -> str:
    """FFmpeg's executable: the machine's own, or that of imageio-ffmpeg; raises BadInputError where there is none."""
    found = shutil.which("ffmpeg")
    if found:
        return found
    if find_spec("imageio_ffmpeg") is None:
        raise BadInputError(
            "mp4 needs FFmpeg, which is not on this machine; install it (Debian: apt-get install ffmpeg; "
            'or: pip install "meshwind[movie]"), or ask for gif'
        )
    from imageio_ffmpeg import get_ffmpeg_exe

    return str(get_ffmpeg_exe())
