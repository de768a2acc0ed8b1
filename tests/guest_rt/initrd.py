"""Archives that a Linux kernel unpacks as its first root (cpio, format newc): the same bytes for the same contents, whoever
makes them and wherever: names sorted, owner root, all times zero. Several may be concatenated."""
import os
import stat
import tarfile
from pathlib import Path

_ALIGNMENT = 4
_BLOCK = 512  # an archive that is padded to blocks can be followed by another


class Initrd:
    """Collects folders, files, links and device nodes by their name in the guest (without the leading slash)."""

    def __init__(self):
        self._entries = {}  # name -> (mode, (device major, minor), content: bytes, Path or None)

    def __contains__(self, name):
        return self._clean(name) in self._entries

    @staticmethod
    def _clean(name):
        return os.path.normpath(str(name)).lstrip("/")

    def _add(self, name, mode, content=None, device=(0, 0)):
        name = self._clean(name)
        if name in ("", "."):
            return
        parent = os.path.dirname(name)
        if parent and parent not in self._entries:
            self._add(parent, stat.S_IFDIR | 0o755)
        self._entries[name] = (mode, device, content)

    def add_folder(self, name, permissions=0o755):
        self._add(name, stat.S_IFDIR | permissions)

    def add_text(self, name, text, permissions=0o644):
        self._add(name, stat.S_IFREG | permissions, text.encode())

    def add_link(self, name, target):
        self._add(name, stat.S_IFLNK | 0o777, str(target).encode())

    def add_file(self, name, path, permissions=None):
        """The file that `path` is or leads to; executable if it is so on the host."""
        path = Path(path).resolve()
        if permissions is None:
            permissions = 0o755 if os.access(path, os.X_OK) else 0o644
        self._add(name, stat.S_IFREG | permissions, path)

    def add_tree(self, name, folder):
        """A folder of the host with everything in it; links stay links."""
        for here, folders, files in os.walk(folder):
            inside = os.path.join(name, os.path.relpath(here, folder))
            self.add_folder(inside)
            for entry in folders + files:
                path = Path(here, entry)
                if path.is_symlink():
                    self.add_link(os.path.join(inside, entry), os.readlink(path))
                elif path.is_file():
                    self.add_file(os.path.join(inside, entry), path)

    def add_tar(self, path):
        """Everything in a tar archive, with its permissions; of its owners only root is kept: one user is enough here."""
        kinds = {tarfile.DIRTYPE: stat.S_IFDIR, tarfile.CHRTYPE: stat.S_IFCHR, tarfile.BLKTYPE: stat.S_IFBLK,
                 tarfile.FIFOTYPE: stat.S_IFIFO}
        with tarfile.open(path) as tar:
            for member in tar:
                if member.issym():
                    self.add_link(member.name, member.linkname)
                elif member.isreg():
                    self._add(member.name, stat.S_IFREG | member.mode & 0o7777, tar.extractfile(member).read())
                elif member.islnk():
                    self._entries[self._clean(member.name)] = self._entries[self._clean(member.linkname)]
                else:
                    self._add(member.name, kinds[member.type] | member.mode & 0o7777,
                              device=(member.devmajor, member.devminor))

    def write(self, path):
        with open(path, "wb") as out:
            for number, name in enumerate(sorted(self._entries), start=1):
                mode, device, content = self._entries[name]
                data = content.read_bytes() if isinstance(content, Path) else content or b""
                self._write_entry(out, name, number, mode, device, data)
            self._write_entry(out, "TRAILER!!!", 0, 0, (0, 0), b"")
            out.write(b"\0" * (-out.tell() % _BLOCK))

    @staticmethod
    def _write_entry(out, name, number, mode, device, data):
        links = 2 if stat.S_ISDIR(mode) else 1
        name = name.encode() + b"\0"
        fields = (number, mode, 0, 0, links, 0, len(data), 0, 0, *device, len(name), 0)
        header = b"070701" + b"".join(b"%08X" % field for field in fields) + name
        out.write(header + b"\0" * (-len(header) % _ALIGNMENT))
        out.write(data + b"\0" * (-len(data) % _ALIGNMENT))
