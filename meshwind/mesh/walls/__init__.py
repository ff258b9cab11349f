"""Parts with a wall: their outer and their inner skin, and the small handles of scans."""
