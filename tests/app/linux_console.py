"""Look at the desktop on a real Linux console, in a machine of QEMU's: no test, a tool for people.

    apt-get install -y --no-install-recommends qemu-system-x86
    apt-get download linux-image-6.1.0-50-amd64 busybox-static kbd console-setup-linux
    for package in *.deb; do dpkg -x $package system; done
    python -m tests.app.linux_console system pictures examples/ch2/lorenz.src -- f5 40 =run alt-j 5 =jump

Words behind `--`: a key in QEMU's names (`f5`, `ctrl-p`, `shift-f1`), a number of seconds to wait, `=NAME` for a
picture `pictures/NAME.ppm`. The machine boots a kernel of Debian without KVM (30 s; Python is 20 times slower
than outside), takes this machine's files by 9p, read only, and starts the desktop on tty1 with TERM=linux. If
the program is a folder, its files are what a desktop wrote elsewhere to a terminal of TERM=linux and that size:
they are shown one after the other, at each `ret`.
`--font Lat15-Fixed16` loads a font of console-setup's, as Debian does; else the kernel's own is there;
`--vga 791` is a framebuffer of 128 x 48 characters, else VGA's text mode of 80 x 25.
"""

from __future__ import annotations

import argparse
import gzip
import os
import shutil
import socket
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).parents[2]
MODULES = (
    "drivers/virtio/virtio", "drivers/virtio/virtio_ring", "drivers/virtio/virtio_pci_legacy_dev",
    "drivers/virtio/virtio_pci_modern_dev", "drivers/virtio/virtio_pci", "net/9p/9pnet", "net/9p/9pnet_virtio",
    "fs/netfs/netfs", "fs/fscache/fscache", "fs/9p/9p",
)  # fmt: skip
"""In the order of their needs."""
INIT = """#!/bin/busybox sh
export PATH=/bin
/bin/busybox --install -s /bin
mount -t devtmpfs dev /dev; mount -t proc proc /proc; mount -t sysfs sys /sys
ip link set lo up
[ -f /font ] && setfont /font -C /dev/tty1
for recording in /recordings/*; do [ -f $recording ] && {{ cat $recording >/dev/tty1; read next </dev/tty1; }}; done
for module in {modules}; do insmod /modules/$module.ko; done
mount -t 9p -o trans=virtio,version=9p2000.L,ro,cache=loose,msize=512000 host /host
for place in dev proc sys; do mount --bind /$place /host/$place; done
mount -t tmpfs tmp /host/tmp; mkdir /host/tmp/home /host/tmp/work
cp /program.src /host/tmp/work/
cat > /host/tmp/start <<'END'
cd /tmp/work
export HOME=/tmp/home TERM=linux LANG=C.UTF-8 PYTHONPATH={tree} PYTHONDONTWRITEBYTECODE=1
{python} -m desire_tui program.src
echo "ended: $?"
exec sh
END
setsid chroot /host /bin/sh -c 'exec /bin/sh /tmp/start </dev/tty1 >/dev/tty1 2>&1'
exec sh </dev/tty1 >/dev/tty1 2>&1  # what went wrong is seen
"""


def main() -> None:
    """Boot, press, take pictures."""
    words = sys.argv[1:]
    keys = words[words.index("--") + 1 :] if "--" in words else []
    reader = argparse.ArgumentParser()
    reader.add_argument("system", type=Path)
    reader.add_argument("pictures", type=Path)
    reader.add_argument("program", type=Path)
    reader.add_argument("--font")
    reader.add_argument("--vga")
    reader.add_argument("--tree", type=Path, default=ROOT)
    given = reader.parse_args(words[: words.index("--")] if "--" in words else words)
    given.pictures.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as folder:
        memory = _first_files(Path(folder), given)
        monitor = Path(folder, "monitor")
        machine = subprocess.Popen(_qemu(given, memory, monitor), stdin=subprocess.DEVNULL)
        try:
            _play(monitor, keys, given.pictures)
        finally:
            machine.terminate()
            machine.wait()


def _first_files(folder: Path, given: argparse.Namespace) -> Path:
    """Return the initial files of the machine as an archive: busybox, modules, the program, `init`."""
    files = folder / "files"
    for name in ("bin", "dev", "proc", "sys", "host", "modules"):
        (files / name).mkdir(parents=True)
    shutil.copy(given.system / "bin" / "busybox", files / "bin")
    if given.program.is_dir():
        shutil.copytree(given.program, files / "recordings")
    else:
        shutil.copy(given.program, files / "program.src")
    (kernel,) = (given.system / "lib" / "modules").iterdir()
    found = []
    for module in MODULES:
        path = kernel / "kernel" / f"{module}.ko"
        if path.exists():  # else it is part of the kernel
            shutil.copy(path, files / "modules")
            found.append(path.stem)
    if given.font:
        fonts = given.system / "usr" / "share" / "consolefonts"
        (files / "font").write_bytes(gzip.decompress((fonts / f"{given.font}.psf.gz").read_bytes()))
    init = files / "init"
    init.write_text(
        INIT.format(
            modules=" ".join(found), program=given.program.name, tree=given.tree, python=sys.executable
        )
    )
    init.chmod(0o755)
    archive = folder / "files.cpio"
    names = "\n".join(str(path.relative_to(files)) for path in sorted(files.rglob("*")))
    subprocess.run(
        [files / "bin" / "busybox", "cpio", "-o", "-H", "newc", "-F", archive],
        input=names, text=True, cwd=files, check=True, stderr=subprocess.DEVNULL,
    )  # fmt: skip
    return archive


def _qemu(given: argparse.Namespace, memory: Path, monitor: Path) -> list[str]:
    (kernel,) = (given.system / "boot").glob("vmlinuz-*")
    return [
        "qemu-system-x86_64", "-m", "1500", "-cpu", "max", "-smp", "1", "-display", "none", "-vga", "std",
        "-kernel", str(kernel), "-initrd", str(memory),
        "-append", "loglevel=1 console=tty1 console=ttyS0 rdinit=/init" + (f" vga={given.vga}" if given.vga else ""),
        "-virtfs", "local,path=/,mount_tag=host,security_model=none,readonly=on,multidevs=remap",
        "-monitor", f"unix:{monitor},server,nowait", "-serial", f"file:{given.pictures}/log", "-no-reboot",
    ]  # fmt: skip


def _play(monitor: Path, keys: list[str], pictures: Path) -> None:
    with socket.socket(socket.AF_UNIX) as line:
        for _ in range(100):
            try:
                line.connect(os.fspath(monitor))
                break
            except OSError:
                time.sleep(0.1)
        for word in keys:
            if word.startswith("="):
                line.sendall(f"screendump {(pictures / word[1:]).absolute()}.ppm\n".encode())
                time.sleep(1)
            elif word.replace(".", "").isdigit() and len(word) > 1:
                time.sleep(float(word))
            else:
                line.sendall(f"sendkey {word}\n".encode())
                time.sleep(0.3)


if __name__ == "__main__":
    main()
