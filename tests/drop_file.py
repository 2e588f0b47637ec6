"""Drops files on a window, as a file manager does, by the X11 drag-and-drop protocol (XDND 5).

    drop_file.py [--until-titled NEW] TITLE FILE...

TITLE is a part of the window's title. Ends with 0 once the window says that it took the files, or once its title
contains NEW.
Needs python3-xlib and an X server, which may be Xvfb.
"""

import argparse
import pathlib
import sys
import time

from Xlib import X, display
from Xlib.error import BadWindow
from Xlib.protocol import event

# For the window to appear, to take the files, and to change its title.
PATIENCE_S = 30.0
# So long the files hover, so that a highlighted drop target can be seen.
HOVER_S = 1.0


def main(title, paths, until_titled):
    server = display.Display()
    target = awaited(server, title)
    source = server.screen().root.create_window(0, 0, 1, 1, 0, X.CopyFromParent)
    uris = "".join(pathlib.Path(path).resolve().as_uri() + "\r\n" for path in paths).encode()
    source.set_selection_owner(server.intern_atom("XdndSelection"), X.CurrentTime)

    def tell(kind, *words):
        data = [source.id, *words] + [0] * (4 - len(words))
        message = event.ClientMessage(window=target, client_type=server.intern_atom(kind), data=(32, data))
        target.send_event(message)
        server.flush()

    tell("XdndEnter", 5 << 24, server.intern_atom("text/uri-list"))
    size = target.get_geometry()
    middle = target.translate_coords(server.screen().root, 0, 0)
    x, y = size.width // 2 - middle.x, size.height // 2 - middle.y
    tell("XdndPosition", 0, max(x, 0) << 16 | max(y, 0), X.CurrentTime, server.intern_atom("XdndActionCopy"))
    dropped = False
    for news in events(server, time.monotonic() + PATIENCE_S):
        if news.type == X.SelectionRequest:
            hand_over(news, uris)
            server.flush()
        elif news.type == X.ClientMessage:
            kind = server.get_atom_name(news.client_type)
            accepted = news.data[1][1] & 1
            if kind == "XdndStatus" and accepted and not dropped:
                time.sleep(HOVER_S)
                dropped = True
                tell("XdndDrop", 0, X.CurrentTime)
            elif kind == "XdndFinished":
                if until_titled:
                    awaited(server, until_titled)
                return
    sys.exit("the window did not take the files")


def awaited(server, title):
    """The window of that title, as soon as there is one."""
    until = time.monotonic() + PATIENCE_S
    while time.monotonic() < until:
        try:
            found = window_titled(server, server.screen().root, title)
        except BadWindow:
            # It went away between two questions.
            found = None
        if found is not None:
            return found
        time.sleep(0.1)
    sys.exit(f"no window whose title has {title!r}")


def window_titled(server, window, title):
    """The first window below whose title contains the words."""
    for child in window.query_tree().children:
        name = child.get_full_text_property(server.intern_atom("_NET_WM_NAME")) or child.get_wm_name()
        found = child if name and title in name else window_titled(server, child, title)
        if found is not None:
            return found
    return None


def hand_over(request, uris):
    """Answers a window that asks for the dragged paths."""
    request.requestor.change_property(request.property, request.target, 8, uris)
    answer = event.SelectionNotify(
        time=request.time,
        requestor=request.requestor,
        selection=request.selection,
        target=request.target,
        property=request.property,
    )
    request.requestor.send_event(answer)


def events(server, until):
    """What the server sends, until then."""
    while time.monotonic() < until:
        if server.pending_events():
            yield server.next_event()
        else:
            time.sleep(0.02)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("--until-titled", metavar="NEW")
    parser.add_argument("title")
    parser.add_argument("file", nargs="+")
    told = parser.parse_args()
    main(told.title, told.file, told.until_titled)
